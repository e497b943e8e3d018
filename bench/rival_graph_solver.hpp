#pragma once

#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::bench {

// Whether the independent solver was found when this was built (Debian's libmrpt-graphslam-dev).
bool has_rival_graph_solver();

// Moves the nodes by mrpt's sparse pose adjustment (Levenberg-Marquardt), all edges believed; the
// first node stays. Not to be called without it.
void solve_by_rival(optimize::PoseGraph& graph);

}  // namespace samewhere::bench
