#pragma once

#include <samewhere/optimize/config.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::correct {

// The edit that adds the loop edge and moves every keyframe to where odometry and all loops fit
// best. The first keyframe stays. Throws ContractError if the loop names keyframes that are not
// there.
scene::Edit close_loop(const scene::MapVersion& map, const scene::LoopEdge& loop,
                       const optimize::Config& config);

}  // namespace samewhere::correct
