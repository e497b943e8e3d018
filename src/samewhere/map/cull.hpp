#pragma once

#include <samewhere/features/config.hpp>
#include <samewhere/map/config.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::map {

// The edit that takes out what did not prove itself. Landmarks that the keyframe
// `cull_after_keyframes` before the newest brought, if no second keyframe saw them, or if too few
// of the keyframes since then that should see them do: most points of a cluttered view are never
// found again, and a map that kept them all would grow without end. And at most one keyframe a
// call: that of the newest one's neighbours of whose landmarks three others see the largest share,
// on the same or a finer level of the pyramid, if that share is large enough. Never one without
// odometry, one that a loop edge holds, or one of the latest. Source: Mur-Artal, Montiel and
// Tardos, IEEE T-RO 2015, sections VI.B and VI.E; that a landmark which two have seen is only
// blamed where it should be seen is ours: a camera that turns away proves nothing.
scene::Edit cull_around(const scene::MapVersion& map, core::KeyframeId newest, const Config& config,
                        const features::Config& features);

}  // namespace samewhere::map
