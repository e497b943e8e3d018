#pragma once

#include <vector>

#include <samewhere/features/config.hpp>
#include <samewhere/map/mapper.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::map {

// Two places that a loop had made one were parted: `before` is the map with the loop, `after` the
// one without it, its poses solved anew. The edits, to be applied to `after` in order, that take
// out what is far off now (three times the limit of an inlier, in pixels):
// - merges with younger landmarks, or for other loops, made while the loop was there, if most of
//   the observations that came with them are (scene::withdraw() has taken the others back);
// - sightings that fitted before (chi-square at 95 %); one that fits another of the landmarks that
//   were one until now is handed to it;
// - landmarks of which one observation without depth is left.
// Landmarks of keyframes that lost sightings stand where the depths of all theirs say, until a
// bundle comes.
std::vector<scene::Edit> part_places(const scene::MapVersion& before,
                                     const scene::MapVersion& after,
                                     const features::Config& features);

// Of the landmarks that the view shows, those that the map still has there. To be asked when places
// were parted after the view was tracked.
scene::TrackedView without_parted(const scene::MapVersion& map, scene::TrackedView tracked,
                                  const features::Config& features);

}  // namespace samewhere::map
