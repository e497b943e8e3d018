#pragma once

// For the files of this folder: how slots of keyframes and observations of landmarks are kept
// equal.

#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {

// The keyframe's feature shows this landmark from now on, or none if it is invalid.
void set_slot(MapVersion& map, const Observation& observation, core::LandmarkId landmark);

core::LandmarkId shown_at(const MapVersion& map, const Observation& observation);

// How the keyframe sees the landmark becomes how it looks: descriptor, pyramid level, range and
// direction.
void look_as_seen(const MapVersion& map, Landmark& landmark, const Observation& observation);

}  // namespace samewhere::scene
