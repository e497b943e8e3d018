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
  bool is_loop = false;  // may be a lie; other edges are believed
  // In a graph with scales only: the logarithm of b's unit in units of a, and its information.
  double log_scale = 0.0;
  double scale_information = 1.0;
  // A loop that was refused when it was asked last. While all others fit, it is believed only if it
  // fits them; else all are asked anew.
  bool is_doubted = false;
};

// Which of the six numbers of an error a planar graph uses: x, y and the turn about z.
inline constexpr std::array<int, 3> kPlanarRows = {0, 1, 5};

struct PoseGraph {
  std::vector<core::Rigid3> world_from_node;
  std::vector<PoseEdge> edges;
  std::vector<int> fixed_nodes = {};  // they stay; see held_nodes
  bool is_planar = false;             // every pose and edge lies in the plane z = 0, turned about z
  // Of a camera without depth, whose unit of length creeps: for each node, the logarithm of its
  // unit in those of the world. Poses are Sim3 then, as Strasdat, Montiel and Davison (RSS 2010)
  // have them. Empty: all share one unit. No graph has scales and is planar.
  std::vector<double> log_scales = {};
};

inline bool has_scales(const PoseGraph& graph) { return !graph.log_scales.empty(); }

struct PoseGraphSummary {
  double initial_cost = 0.0;  // half of the squared errors, in variances, of the edges believed
  double final_cost = 0.0;
  int num_iterations = 0;
  bool has_converged = false;  // of the last solve: not ended by its limit of iterations
  // What the loss makes as small as it can, to tell which of two starts ended better: final_cost,
  // and with kGnc half of the limit for each loop that is refused; a stretch refused as a whole is
  // one.
  double robust_cost = 0.0;
  // Per edge: 0 if it was refused, 1 if it is believed, between where it counts less. Those that
  // are no loops have 1.
  std::vector<double> weights;
};

// Moves the nodes to where the edges fit best, under Config::loop_loss. With kGnc, a loop edge is
// believed or refused as a whole: graduated non-convexity for truncated least squares (Yang,
// Antonante, Tzoumas and Carlone, RA-L 2020), then a check of every loop edge against
// Config::loop_chi2 (of 6 degrees of freedom; as likely a value where there are 3 or 7) in the
// graph as it came out, and up to ten solutions more until no edge changes sides; what was refused
// is asked again three times, from nearer and nearer, and refused loops that say the same once
// together, as one claim (not in a graph with scales). Where all fit but for the one that is bent
// most, that one is refused and nothing else is asked. Loops are taken in the order of their later
// nodes: a stretch of them at whose ends many were refused counts as one claim, and is refused as a
// whole if that makes the rest fit. kGncEach: the published method alone, without check, asking
// again and claims. kDcs: Agarwal et al., ICRA 2013. Throws ContractError for an edge to a node
// that is not there, and for scales of some nodes alone or of a planar graph.
PoseGraphSummary solve_pose_graph(PoseGraph& graph, const Config& config);

// Error of an edge, not whitened, of nodes that share one unit.
core::Vector6d edge_error(const PoseEdge& edge, const core::Rigid3& world_from_a,
                          const core::Rigid3& world_from_b);

// Its squared error in variances, chi-square with 6 degrees of freedom (3 in a planar graph, 7 in
// one with scales) if the edge tells the truth.
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

// The same over edges that are no loops: two walks that only loops join are two stretches.
std::vector<int> stretches_of(const PoseGraph& graph);

// What holds the graph in place: the fixed nodes, and the lowest node of every part that has none.
std::vector<int> held_nodes(const PoseGraph& graph);

}  // namespace samewhere::optimize
