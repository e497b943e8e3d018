#pragma once

#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {

// Puts each node where the edges lead from those that hold the graph (held_nodes): over edges that
// are no loops as far as these go, over loops from there. A start for who does not trust the poses
// that the nodes have; in a graph with scales the units come along. Throws ContractError for an
// edge to a node that is not there.
void lay_out(PoseGraph& graph);

}  // namespace samewhere::optimize
