#pragma once

// For the files of this folder that solve pose graphs.

#include <vector>

#include <samewhere/optimize/pose_block.hpp>
#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {

// The edges of a graph as a problem of Ceres, built once and solved with changing weights. An edge
// of weight 0 is not part of the problem: a false loop closure joins distant nodes and makes the
// factorization slower.
class EdgeProblem {
 public:
  // Keeps a reference to the graph. Throws ContractError for an edge to a node that is not there.
  EdgeProblem(PoseGraph& graph, const Config& config);
  EdgeProblem(const EdgeProblem&) = delete;
  EdgeProblem& operator=(const EdgeProblem&) = delete;

  double& weight(std::size_t edge) { return weights_[edge]; }
  const std::vector<double>& weights() const { return weights_; }
  // Takes over poses that the graph's nodes were given since.
  void start_from_graph();
  // Moves the graph's nodes; the costs are those under the current weights.
  PoseGraphSummary solve(int max_iterations);

 private:
  ceres::LossFunction* loss_of(std::size_t edge) const;
  void update_edges();
  ceres::ResidualBlockId add_edge(std::size_t edge);

  PoseGraph& graph_;
  Config config_;
  std::vector<double> weights_;  // per edge
  std::vector<PoseBlock> blocks_;
  std::vector<double> log_scales_;  // per node, or none
  ceres::Problem problem_;
  std::vector<ceres::ResidualBlockId> residuals_;  // per edge; null: weight 0
};

}  // namespace samewhere::optimize
