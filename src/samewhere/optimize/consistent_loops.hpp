#pragma once

// For the files of this folder that solve pose graphs.

#include <cstddef>
#include <vector>

#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {

// Which of these edges say the same, in groups of two or more, the largest first, twenty at most:
// their ends are near each other on one walk, and where the one would put the other is no further
// off than `limit` variances of as many edges as lie between them. Of a graph whose nodes share one
// unit.
std::vector<std::vector<std::size_t>> loops_that_agree(const PoseGraph& graph,
                                                       const std::vector<std::size_t>& edges,
                                                       double limit);

}  // namespace samewhere::optimize
