#pragma once

#include <array>
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
  bool is_loop = false;  // may be a lie; other edges are believed
};

// Which of the six numbers of an error a planar graph uses: x, y and the turn about z.
inline constexpr std::array<int, 3> kPlanarRows = {0, 1, 5};

struct PoseGraph {
  std::vector<core::Rigid3> world_from_node;
  std::vector<PoseEdge> edges;
  std::vector<int> fixed_nodes = {};  // they stay; see held_nodes
  bool is_planar = false;             // every pose and edge lies in the plane z = 0, turned about z
};

struct PoseGraphSummary {
  double initial_cost = 0.0;  // half of the squared errors, in variances, of the edges believed
  double final_cost = 0.0;
  int num_iterations = 0;
  // Per edge: 0 if it was refused, 1 if it is believed, between where it counts less. Those that
  // are no loops have 1.
  std::vector<double> weights;
};

// Moves the nodes to where the edges fit best, under Config::loop_loss. With kGnc, a loop edge is
// believed or refused as a whole: graduated non-convexity for truncated least squares (Yang,
// Antonante, Tzoumas and Carlone, RA-L 2020), then a check of every loop edge against
// Config::loop_chi2 in the graph as it came out, and as many solutions more as it takes until no
// edge changes sides; what was refused is asked again three times, from nearer and nearer. kDcs:
// Agarwal et al., ICRA 2013. Throws ContractError for an edge to a node that is not there.
PoseGraphSummary solve_pose_graph(PoseGraph& graph, const Config& config);

// Error of an edge, not whitened.
core::Vector6d edge_error(const PoseEdge& edge, const core::Rigid3& world_from_a,
                          const core::Rigid3& world_from_b);

// Its squared error in variances, chi-square with 6 degrees of freedom (3 in a planar graph) if
// the edge tells the truth.
double chi2_of(const PoseGraph& graph, const PoseEdge& edge);

// Derivatives of the error by retract() at a and b.
struct EdgeJacobians {
  core::Matrix6d by_a;
  core::Matrix6d by_b;
};

EdgeJacobians edge_jacobians(const PoseEdge& edge, const core::Rigid3& world_from_a,
                             const core::Rigid3& world_from_b);

// For each node, the lowest of those that it is joined to by edges, itself if there is none.
std::vector<int> parts_of(const PoseGraph& graph);

// What holds the graph in place: the fixed nodes, and the lowest node of every part that has none.
std::vector<int> held_nodes(const PoseGraph& graph);

}  // namespace samewhere::optimize
