#pragma once

// For the files of this folder that solve pose graphs.

#include <cstddef>
#include <vector>

#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {

// Groups of two or more of these loop edges that are consistent with each other, the largest first.
// Two are consistent if odometry joins their ends, at most config.max_gap_nodes nodes apart, and
// one predicts the other with a squared error of at most `limit` for each edge between them. Of a
// graph whose nodes share one unit. A weaker form of pairwise consistency (Mangelson et al., ICRA
// 2018), without covariances of odometry.
std::vector<std::vector<std::size_t>> consistent_loops(const PoseGraph& graph,
                                                       const std::vector<std::size_t>& edges,
                                                       double limit, const LoopGroupConfig& config);

}  // namespace samewhere::optimize
