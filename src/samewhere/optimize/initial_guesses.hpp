#pragma once

#include <string_view>

#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {

// From which poses a solution was reached: those that the nodes had, those where odometry and then
// loops lead (lay_out.hpp), those of the chordal relaxation (chordal.hpp).
enum class GraphStart { kGiven, kOdometry, kChordal };

std::string_view name_of(GraphStart start);

struct AnyStartSummary {
  PoseGraphSummary solution;  // costs before are those of the poses that were given
  GraphStart start = GraphStart::kGiven;
};

// As solve_pose_graph, of a graph whose poses come from elsewhere and may be far from the best or
// from the origin. Solved about the first held node, which stays as it was to the last bit. The
// starts are taken in the order of their squared errors; the first after which noise explains all
// squared errors (their sum is within 5 standard deviations of its expectation, under 2 % of the
// loops refused), or of more than 2000 poses that refuses some loops but not half, is the answer,
// else the one that ended with the least robust cost. Then the edges believed are solved to the
// end: PoseGraphSummary::has_converged says whether it was reached within four times
// Config::graph_iterations.
AnyStartSummary solve_from_any_start(PoseGraph& graph, const Config& config);

}  // namespace samewhere::optimize
