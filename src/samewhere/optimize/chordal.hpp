#pragma once

#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {

// Initial poses from two linear problems, whatever poses the nodes have: first the
// rotations, as matrices without the condition that they are rotations, each then replaced by the
// nearest one (chordal relaxation: Martinec and Pajdla, CVPR 2007; Carlone, Tron, Daniilidis and
// Dellaert, ICRA 2015), then the positions under these rotations. All edges count, loops as well,
// each with the mean of its information. Held nodes (held_nodes) stay. An initial guess for a
// solver that would end in a local minimum, not a solution. Of a graph whose nodes share one unit;
// throws ContractError for one with scales and for an edge to a node that is not there.
void place_by_chordal_relaxation(PoseGraph& graph);

}  // namespace samewhere::optimize
