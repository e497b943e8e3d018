#pragma once

#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {

// Puts each node where the edges lead from those that hold the graph (held_nodes): over edges that
// are no loops as far as these go, over loops from there. A start for who does not trust the poses
// that the nodes have; in a graph with scales the units come along.
void lay_out(PoseGraph& graph);

// Half of the squared errors of all edges, in variances, of a loop no more than
// Config::loop_chi2: what graduated non-convexity makes as small as it can.
double truncated_cost(const PoseGraph& graph, const Config& config);

}  // namespace samewhere::optimize
