#pragma once

// For the files of this folder that solve pose graphs.

#include <optional>
#include <vector>

#include <samewhere/optimize/edge_problem.hpp>
#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {

// A pose graph whose loop edges have weights between 0 (outlier) and 1 (inlier), and the truncated
// least squares cost over them: what the steps of graduated non-convexity share.
class RobustGraph {
 public:
  struct State {
    std::vector<core::Rigid3> poses;
    std::vector<double> log_scales;
    std::vector<double> weights;
    std::vector<std::optional<double>> segment_costs;
    int num_rejected_segments = 0;
  };

  // Keeps references to both.
  RobustGraph(PoseGraph& graph, const Config& config);
  RobustGraph(const RobustGraph&) = delete;
  RobustGraph& operator=(const RobustGraph&) = delete;

  const PoseGraph& graph() const { return graph_; }
  const Config& config() const { return config_; }
  // Largest squared error of an inlier, see chi2_limit().
  double limit() const { return limit_; }
  // Edges, in the order of their later nodes.
  const std::vector<std::size_t>& loops() const { return loops_; }
  bool is_suspended(std::size_t loop) const { return graph_.edges[loop].is_suspended; }

  double weight(std::size_t loop) const { return problem_.weights()[loop]; }
  void set_weight(std::size_t loop, double weight) { problem_.weight(loop) = weight; }
  double chi2(std::size_t loop) const { return chi2_of(graph_, graph_.edges[loop]); }
  bool fits(std::size_t loop) const { return chi2(loop) <= limit_; }
  double worst_chi2() const;
  // Sum over the edges of their squared errors, of a loop at most the limit. A segment that was
  // rejected as one counts one limit, and what reject_segment() fixed for its loops.
  double truncated_cost() const;

  // Moves the nodes to the least squares solution under the weights of now.
  void optimize(int max_iterations);
  void optimize() { optimize(config_.graph_iterations); }
  // Rounds of graduated non-convexity from a control parameter up: loop edges with a squared error
  // beyond (control + 1) / control times the limit have no weight. The smaller it is, the more
  // convex the cost.
  void anneal(double control);
  // Accepts what fits and rejects what does not, until no loop edge changes sides.
  void classify();
  // Anneals anew for rejected loop edges up to Config::gnc.retest_ratio times the limit, then
  // within smaller ones; kept where the cost falls. While false loop closures had weight, a part of
  // the trajectory may have been so far off that none of its true loops fitted.
  void retest_rejected();

  // Rejects loops()[begin] to loops()[end - 1] as one hypothesis, whatever fits then. A loop that
  // was accepted counts what a true one does in the mean, so that true loops cost the same inside
  // and outside; one that was rejected still counts the limit.
  void reject_segment(std::size_t begin, std::size_t end);
  bool is_in_rejected_segment(std::size_t loop) const { return segment_costs_[loop].has_value(); }
  std::size_t num_in_rejected_segments() const;
  int num_rejected_segments() const { return num_rejected_segments_; }

  State state() const;
  void restore(const State& state);
  // With the weights and costs of now.
  PoseGraphSummary summary() const;

 private:
  bool update_weights(double control);
  void retest_rejected(double ratio);

  PoseGraph& graph_;
  const Config& config_;
  EdgeProblem problem_;
  double limit_;
  std::vector<std::size_t> loops_;
  std::vector<std::optional<double>> segment_costs_;  // per edge: of loops in rejected segments
  int num_rejected_segments_ = 0;
  std::optional<PoseGraphSummary> summary_;  // of the first solution; iterations of all
};

}  // namespace samewhere::optimize
