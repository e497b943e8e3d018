#pragma once

#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::bench {

// Whether the independent solver was found when this was built (Debian's libmrpt-graphslam-dev).
bool has_other_graph_solver();

// Moves the nodes by mrpt's sparse pose adjustment (Levenberg-Marquardt, least squares over all
// edges); the first node is fixed. Requires has_other_graph_solver().
void solve_with_other(optimize::PoseGraph& graph);

}  // namespace samewhere::bench
