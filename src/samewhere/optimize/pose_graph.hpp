#pragma once

#include <vector>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/optimize/config.hpp>

namespace samewhere::optimize {

// A measured relative pose of two nodes. The error is [translation in a; rotation on the right],
// metres and radians.
struct PoseEdge {
  int a = 0;
  int b = 0;
  core::Rigid3 a_from_b;
  core::Matrix6d information = core::Matrix6d::Identity();
  bool is_loop = false;  // gets the robust loss
};

struct PoseGraph {
  std::vector<core::Rigid3> world_from_node;
  std::vector<PoseEdge> edges;
  int fixed_node = 0;  // holds the whole graph in place
};

struct PoseGraphSummary {
  double initial_cost = 0.0;
  double final_cost = 0.0;
  int num_iterations = 0;
};

// Moves the nodes to where the edges fit best. Throws ContractError for an edge to a node that is
// not there.
PoseGraphSummary solve_pose_graph(PoseGraph& graph, const Config& config);

// Error of an edge, not whitened.
core::Vector6d edge_error(const PoseEdge& edge, const core::Rigid3& world_from_a,
                          const core::Rigid3& world_from_b);

// Derivatives of the error by retract() at a and b.
struct EdgeJacobians {
  core::Matrix6d by_a;
  core::Matrix6d by_b;
};

EdgeJacobians edge_jacobians(const PoseEdge& edge, const core::Rigid3& world_from_a,
                             const core::Rigid3& world_from_b);

}  // namespace samewhere::optimize
