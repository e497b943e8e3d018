#pragma once

#include <samewhere/features/config.hpp>
#include <samewhere/map/config.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::map {

// The edit that triangulates landmarks from features without depth of this keyframe and of its most
// covisible keyframes: two features without a landmark, on each other's epipolar line, with similar
// and unambiguous descriptors. Rejected: small parallax, points behind a camera, large reprojection
// errors (chi-square at 95 %), and ranges inconsistent with the pyramid levels of the two features.
// In a monocular map all landmarks come from here. Source: Mur-Artal, Montiel and Tardos, IEEE T-RO
// 2015, section VI.C.
scene::Edit triangulate_landmarks(const scene::MapVersion& map, core::KeyframeId keyframe,
                                  const Config& config, const features::Config& features);

}  // namespace samewhere::map
