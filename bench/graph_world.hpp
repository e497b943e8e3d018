#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::bench {

// A pose graph with known true poses. Its nodes are initialized by composed odometry.
struct GraphWorld {
  optimize::PoseGraph graph;
  std::vector<core::Rigid3> world_from_node;  // the truth
  std::vector<bool> is_outlier;               // per edge
};

enum class GraphKind {
  kSphere,  // 50 laps of 50 poses around a ball of 50 m, each pose joined to those of the lap below
  kTorus,   // 100 laps of 50 poses around a ring, likewise
  kGrid,    // 3500 steps of 1 m along the streets of a town, joined where it crosses itself; planar
  kTown,    // 10,000 such steps
  kHalls    // 20 rounds of 100 m through the same halls, joined to the round before; planar
};

std::string_view name_of(GraphKind kind);

// Standard deviations of the noise of every edge; the information of each edge is consistent with
// it.
struct GraphNoise {
  double sigma_m = 0.05;
  double sigma_rad = 0.02;
};

GraphWorld make_graph(GraphKind kind, const GraphNoise& noise, std::uint64_t seed);

// The same noisy initialization, but with true relative poses in all edges: the best cost is 0.
GraphWorld with_exact_edges(GraphWorld world);

// Replaces a share of the loop edges, each by an edge to a random other node.
void add_random_outliers(GraphWorld& world, double share, std::uint64_t seed);

// Shifts consecutive loop edges, a share of all, by the same 3 m: they are consistent with each
// other and with the odometry between them.
void add_consistent_outliers(GraphWorld& world, double share, std::uint64_t seed);

// RMSE of the nodes' positions after the best rigid alignment, m.
double ate_m(const GraphWorld& world);

}  // namespace samewhere::bench
