#pragma once

#include <vector>

#include <samewhere/features/config.hpp>
#include <samewhere/map/config.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::map {

// The edit that lets `keyframe` see those of the landmarks that it shows without knowing: a feature
// near the projection that looks like the landmark and fits it (chi-square at 95 %) becomes a
// sighting; if it shows another landmark, the two are one and the one with fewer observations goes
// into the other, unless some picture shows both.
scene::Edit fuse_into(const scene::MapVersion& map, core::KeyframeId keyframe,
                      const std::vector<core::LandmarkId>& landmarks, const Config& config,
                      const features::Config& features);

// The landmarks of the keyframe's neighbours looked for in it, and its own in each of them: edits
// to be applied in order.
std::vector<scene::Edit> fuse_around(const scene::MapVersion& map, core::KeyframeId keyframe,
                                     const Config& config, const features::Config& features);

// Two places are one, says a loop: the landmarks around `match` looked for in `query` and in its
// neighbours. What is merged and seen for it bears its cause. Edits to be applied in order.
std::vector<scene::Edit> fuse_across(const scene::MapVersion& map, const scene::LoopEdge& loop,
                                     const Config& config, const features::Config& features);

}  // namespace samewhere::map
