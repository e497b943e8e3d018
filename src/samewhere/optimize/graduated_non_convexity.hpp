#pragma once

// For the files of this folder that solve pose graphs.

#include <optional>
#include <vector>

#include <samewhere/optimize/robust_graph.hpp>

namespace samewhere::optimize {

// Graduated non-convexity over the loop edges of a graph, see solve_pose_graph.
class GraduatedNonConvexity {
 public:
  // Keeps references to both.
  GraduatedNonConvexity(PoseGraph& graph, const Config& config) : robust_(graph, config) {}

  PoseGraphSummary solve();
  // Solves with all loops and rejects those that do not fit then. Nothing, and the graph as it was,
  // if noise does not explain the rest (is_consistent).
  std::optional<PoseGraphSummary> solve_if_consistent();
  // As published: the rounds alone.
  PoseGraphSummary solve_each();

 private:
  bool solve_without_suspended();
  bool solve_without_worst(const RobustGraph::State& start);
  bool accept_suspended(std::optional<std::size_t> outlier);
  bool others_fit(std::optional<std::size_t> outlier) const;
  bool is_supported(const std::vector<double>& chi2_with,
                    const std::vector<double>& chi2_without) const;
  std::vector<double> chi2_of_loops() const;
  std::size_t worst_loop(const std::vector<double>& chi2) const;
  void solve_with_all();
  void retest_groups();
  bool retest_group(const std::vector<std::size_t>& group);
  bool is_noise() const;

  RobustGraph robust_;
};

}  // namespace samewhere::optimize
