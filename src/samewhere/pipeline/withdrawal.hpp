#pragma once

#include <samewhere/core/ids.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::pipeline {

// Two places that a loop had made one were parted: `before` is the map with the loop, `after` the
// one without it, its poses solved anew. What no longer fits is taken out (map::part_places), the
// keyframes that show something else now go through local bundles, and the poses are solved once
// more, by what these found.
scene::MapVersion with_places_parted(const scene::MapVersion& before, scene::MapVersion after,
                                     const Config& config);

// The map as if the loop had never been accepted: its edge, the landmarks merged and seen for it,
// the poses that it moved, and what mapping and tracking concluded from it later. Which
// landmarks from before it are one is what it was then, exactly, but for what other loops merged;
// poses are as near as the solvers bring them. Keyframes and landmarks that were culled since stay
// culled. Takes any loop that the map has accepted; throws ContractError for another cause.
scene::MapVersion without_loop(const scene::MapVersion& map, core::CandidateId cause,
                               const Config& config);

}  // namespace samewhere::pipeline
