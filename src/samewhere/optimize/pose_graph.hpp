#pragma once

#include <array>
#include <vector>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/optimize/config.hpp>

namespace samewhere::optimize {

// A measured relative pose of two nodes. The error is [translation in a; rotation on the right],
// metres (in a graph with scales: units of a) and radians.
struct PoseEdge {
  int a = 0;
  int b = 0;
  core::Rigid3 a_from_b;
  core::Matrix6d information = core::Matrix6d::Identity();
  bool is_loop = false;  // may be an outlier; other edges are odometry, and inliers
  // In a graph with scales only: the logarithm of b's unit in units of a, and its information.
  double log_scale = 0.0;
  double scale_information = 1.0;
  // A loop that was rejected when it was tested last. While all others fit, it is accepted only if
  // it fits them; else all are tested anew.
  bool is_suspended = false;
};

// Which of the six numbers of an error a planar graph uses: x, y and the turn about z.
inline constexpr std::array<int, 3> kPlanarRows = {0, 1, 5};

struct PoseGraph {
  std::vector<core::Rigid3> world_from_node;
  std::vector<PoseEdge> edges;
  std::vector<int> fixed_nodes = {};  // their poses stay; see held_nodes
  bool is_planar = false;             // every pose and edge lies in the plane z = 0, turned about z
  // Of a camera without depth, with scale drift: for each node, the logarithm of its unit of length
  // in units of the world. Poses are Sim3 then (Strasdat, Montiel and Davison, RSS 2010). Empty:
  // all nodes share one unit. No graph has scales and is planar.
  std::vector<double> log_scales = {};
};

inline bool has_scales(const PoseGraph& graph) { return !graph.log_scales.empty(); }

struct PoseGraphSummary {
  double initial_cost = 0.0;  // half of the squared errors, in variances, of the accepted edges
  double final_cost = 0.0;
  int num_iterations = 0;
  bool has_converged = false;  // of the last solve: not ended by its limit of iterations
  // The minimized loss, to compare solutions from two initial guesses: final_cost, and with kGnc
  // half of the limit for each rejected loop; a segment rejected as one hypothesis counts once.
  double robust_cost = 0.0;
  // Per edge: 0 if it was rejected, 1 if it is accepted, between with Huber and kDcs. Odometry has
  // 1.
  std::vector<double> weights;
};

// Weight from which a loop edge counts as accepted.
inline constexpr double kMinInlierWeight = 0.5;

// Moves the nodes to the least squares solution of the edges under Config::loop_loss.
// kGnc accepts or rejects each loop edge as a whole, by graduated non-convexity for truncated least
// squares (Yang, Antonante, Tzoumas and Carlone, RA-L 2020) and, in addition:
// - every loop edge is tested against Config::loop_chi2 (6 degrees of freedom; the same quantile
//   for 3 or 7) in the solved graph, which is solved again until no edge changes sides;
// - rejected edges are re-tested within shrinking limits, and groups of consistent ones together,
//   each group as one hypothesis (consistent_loops.hpp; not in a graph with scales);
// - a segment of loops, in the order of their later nodes, with rejected loops at its ends is one
//   hypothesis and rejected as a whole if the rest fits then (loop_segments.hpp);
// - if all fit except for the edge with the largest squared error, only that one is rejected;
// - suspended loops are first left out.
// kGncEach: the published method alone. kDcs: Agarwal et al., ICRA 2013. Throws ContractError for
// an edge to a node that is not there, and for scales of some nodes alone or of a planar graph.
PoseGraphSummary solve_pose_graph(PoseGraph& graph, const Config& config);

// Error of an edge, not whitened, of nodes that share one unit.
core::Vector6d edge_error(const PoseEdge& edge, const core::Rigid3& world_from_a,
                          const core::Rigid3& world_from_b);

// Its squared error in variances, chi-square with 6 degrees of freedom (3 in a planar graph, 7 in
// one with scales) of an inlier.
double chi2_of(const PoseGraph& graph, const PoseEdge& edge);

// Derivatives of the error by retract() at a and b.
struct EdgeJacobians {
  core::Matrix6d by_a;
  core::Matrix6d by_b;
};

EdgeJacobians edge_jacobians(const PoseEdge& edge, const core::Rigid3& world_from_a,
                             const core::Rigid3& world_from_b);

// For each node, the lowest node of its connected component.
std::vector<int> connected_components(const PoseGraph& graph);

// The same over odometry alone: two sessions that only loops join are two components.
std::vector<int> odometry_components(const PoseGraph& graph);

// Nodes that fix the gauge: the fixed nodes, and the lowest node of every connected component that
// has none.
std::vector<int> held_nodes(const PoseGraph& graph);

}  // namespace samewhere::optimize
