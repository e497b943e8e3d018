#pragma once

#include <string_view>

#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {

// Initial poses of a solution: those that the nodes had, those along a spanning tree of odometry
// and then loops (spanning_tree.hpp), those of the chordal relaxation (chordal.hpp).
enum class InitialGuess { kGiven, kOdometry, kChordal };

std::string_view name_of(InitialGuess guess);

struct BestOfGuesses {
  PoseGraphSummary solution;  // costs before are those of the given poses
  InitialGuess guess = InitialGuess::kGiven;
};

// As solve_pose_graph, of a graph whose poses come from elsewhere and may be far from the optimum
// or from the origin. Solved about the first held node, whose pose stays bit for bit. Guesses are
// tried in the order of their squared errors. The first solution that noise explains
// (is_consistent) is taken; in a graph of more than Config::initial_guesses.large_graph_nodes poses
// also the first that rejects some loops but not half; else the one with the least robust cost.
// Then the accepted edges are solved to the end: PoseGraphSummary::has_converged says whether it
// was reached within Config::initial_guesses.final_factor times Config::graph_iterations.
BestOfGuesses solve_from_initial_guesses(PoseGraph& graph, const Config& config);

}  // namespace samewhere::optimize
