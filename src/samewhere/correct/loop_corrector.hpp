#pragma once

#include <samewhere/optimize/pose_graph.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::correct {

// Keyframes as nodes, by position, joined by their odometry and by the loops that the map knows.
// Culled keyframes hang on no edge.
optimize::PoseGraph pose_graph_of(const scene::MapVersion& map);

// The edit that adds the loop edge and moves every keyframe to where odometry, refined by bundles,
// and all loops fit best. The first keyframe stays; culled ones move with those that they hang on.
// Throws ContractError if the loop names keyframes that are not there.
scene::Edit close_loop(const scene::MapVersion& map, const scene::LoopEdge& loop,
                       const optimize::Config& config);

}  // namespace samewhere::correct
