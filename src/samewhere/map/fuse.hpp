#pragma once

#include <vector>

#include <samewhere/features/config.hpp>
#include <samewhere/map/config.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::map {

// The edit that adds observations of landmarks to `keyframe`: a feature near the projection with a
// similar descriptor and a consistent position (chi-square at 95 %) becomes an observation. If it
// observes another landmark, the two are merged into the one with more observations, unless a
// keyframe observes both.
scene::Edit fuse_into(const scene::MapVersion& map, core::KeyframeId keyframe,
                      const std::vector<core::LandmarkId>& landmarks, const Config& config,
                      const features::Config& features);

// Landmarks of the covisible keyframes searched in the keyframe, and its own in each of them: edits
// to be applied in order.
std::vector<scene::Edit> fuse_around(const scene::MapVersion& map, core::KeyframeId keyframe,
                                     const Config& config, const features::Config& features);

// After a loop closure: landmarks around `match` searched in `query` and its covisible keyframes.
// Merges and observations carry the loop as their cause. Edits to be applied in order.
std::vector<scene::Edit> fuse_across(const scene::MapVersion& map, const scene::LoopEdge& loop,
                                     const Config& config, const features::Config& features);

}  // namespace samewhere::map
