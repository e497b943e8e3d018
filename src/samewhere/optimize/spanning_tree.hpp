#pragma once

#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {

// Composes the pose of each node from the edges of a spanning tree, rooted at the nodes that fix
// the gauge (held_nodes): along odometry as far as it goes, along loops from there. An initial
// guess that does not depend on the poses of the nodes; in a graph with scales, the units follow
// the edges, too. Throws ContractError for an edge to a node that is not there.
void place_by_spanning_tree(PoseGraph& graph);

}  // namespace samewhere::optimize
