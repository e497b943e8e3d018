#pragma once

// For the files of this folder that solve pose graphs.

#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {

// Degrees of freedom of an edge: 6, of a planar graph 3, of one with scales 7.
double degrees_of_freedom(const PoseGraph& graph);

// Largest squared error of an accepted loop edge, in variances: Config::loop_chi2, scaled to the
// edge's degrees of freedom.
double chi2_limit(const PoseGraph& graph, const Config& config);

// Whether measurement noise explains a solved graph: squared errors that sum up to `chi2` (a
// rejected loop counts chi2_limit) with `num_rejected` rejected loops. Config::consistency has the
// limits; chi2_limit rejects one true loop of a hundred.
bool is_consistent(const PoseGraph& graph, const Config& config, double chi2,
                   std::size_t num_rejected);

}  // namespace samewhere::optimize
