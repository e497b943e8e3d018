#pragma once

#include <samewhere/features/config.hpp>
#include <samewhere/map/config.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::map {

// The edit that culls:
// - Landmarks of the keyframe `cull_after_keyframes` before the newest, if too few of the keyframes
//   since then in which they should be visible observe them, or if a single observation without
//   depth is left.
// - Landmarks of the keyframe `cull_unmatched_after_keyframes` before the newest that no second
// keyframe
//   observed: most points of a cluttered view are never matched again, and a map that kept them all
//   would grow without bound.
// - At most one keyframe: that of the newest one's neighbours of whose landmarks three others see
//   the largest share, on the same or a finer level of the pyramid, if that share is large enough.
//   Never one without odometry, one that a loop edge holds, or one of the latest.
// Source: Mur-Artal, Montiel and Tardos, IEEE T-RO 2015, sections VI.B and VI.E; that a landmark
// is blamed early only where it should be seen is ours.
scene::Edit cull_around(const scene::MapVersion& map, core::KeyframeId newest, const Config& config,
                        const features::Config& features);

}  // namespace samewhere::map
