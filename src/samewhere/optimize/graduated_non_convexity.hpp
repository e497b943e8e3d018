#pragma once

// For the files of this folder that solve pose graphs.

#include <optional>
#include <vector>

#include <samewhere/optimize/edge_problem.hpp>
#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {

// Whether noise explains squared errors that sum up to `chi2` (a refused loop at the limit), with
// so many loops refused: chance refuses one of a hundred.
bool is_consistent(const PoseGraph& graph, double chi2, std::size_t num_refused);

// Graduated non-convexity over the loop edges of a graph, see solve_pose_graph.
class Graduation {
 public:
  // Keeps references to both.
  Graduation(PoseGraph& graph, const Config& config);

  PoseGraphSummary solve();
  // Solves with all loops and refuses those that do not fit then: of a graph in which noise
  // explains the rest, nothing more is needed. Nothing (and the graph as it was) if it does not.
  std::optional<PoseGraphSummary> solve_if_consistent();
  // As published: nothing but the rounds.
  PoseGraphSummary solve_each();

 private:
  struct State {
    std::vector<core::Rigid3> poses;
    std::vector<double> log_scales;
    std::vector<double> weights;
    std::vector<std::optional<double>> outvoted;
    std::size_t num_stretches = 0;
  };
  // Loops that stand in a row, in the order of their later ends.
  struct Stretch {
    std::size_t begin = 0;
    std::size_t end = 0;
  };

  PoseGraphSummary weighed(PoseGraphSummary summary) const;
  void ask_all(PoseGraphSummary& summary);
  void go_on(int max_iterations, PoseGraphSummary& summary);
  bool all_fit(const State& start, PoseGraphSummary& summary);
  bool all_but_one_fit(const State& start, PoseGraphSummary& summary);
  bool fit_with_doubted(std::size_t liar, PoseGraphSummary& summary);
  bool believed_fit(std::size_t liar) const;
  std::vector<double> chi2_of_loops() const;
  double worst_chi2() const;
  double truncated_cost() const;
  void graduate(double control, PoseGraphSummary& summary);
  void call_back(double reach, PoseGraphSummary& summary);
  void call_back_those_that_agree(PoseGraphSummary& summary);
  bool weigh(double control);
  void settle(PoseGraphSummary& summary);

  std::vector<Stretch> quarrels() const;
  std::vector<Stretch> suspects() const;
  bool is_minority(const Stretch& stretch) const;
  void outvote(const Stretch& stretch, PoseGraphSummary& summary);
  std::vector<Stretch> prime_suspects(PoseGraphSummary& summary);
  bool outvote_worst(PoseGraphSummary& summary);

  State state() const;
  void go_back(const State& state);

  PoseGraph& graph_;
  const Config& config_;
  EdgeProblem problem_;
  double limit_;
  std::vector<std::size_t> loops_;               // edges, in the order of their later ends
  std::vector<std::optional<double>> outvoted_;  // per edge: what it counts since
  std::size_t num_stretches_ = 0;                // that were outvoted
};

}  // namespace samewhere::optimize
