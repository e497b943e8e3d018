#pragma once

// For the files of this folder that solve pose graphs.

#include <samewhere/optimize/robust_graph.hpp>

namespace samewhere::optimize {

// Rejects one segment of loop edges, in the order of their later nodes, as one hypothesis if that
// lowers the robust cost by Config::loop_segments.min_gain; returns whether it did. False loop
// closures between two look-alike places are consistent with each other, and their number is no
// evidence. Candidates are the segments between two conflicts: rows of rejected loops, where the
// two hypotheses meet and the graph rejects some loops of both, and both ends of the trajectory.
bool reject_worst_segment(RobustGraph& robust);

}  // namespace samewhere::optimize
