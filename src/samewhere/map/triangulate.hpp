#pragma once

#include <samewhere/features/config.hpp>
#include <samewhere/map/config.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::map {

// The edit that makes landmarks of features without depth, of this keyframe and of those that share
// most landmarks with it: two features that show no landmark yet, lie on each other's epipolar
// line, look alike and like nothing else there. Refused: rays with too small an angle between them,
// points behind a camera or off either pixel (chi-square at 95 %), and ranges that do not go with
// the levels of the pyramid on which the two were found. In a monocular map all landmarks come from
// here. Source: Mur-Artal, Montiel and Tardos, IEEE T-RO 2015, section VI.C.
scene::Edit triangulate_landmarks(const scene::MapVersion& map, core::KeyframeId keyframe,
                                  const Config& config, const features::Config& features);

}  // namespace samewhere::map
