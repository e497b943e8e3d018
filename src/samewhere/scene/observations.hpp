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

// A landmark whose anchor was culled hangs on the first keyframe that sees it from now on, in its
// place in the world: it moves with those who see it, not with the odometry parent of one who did.
void hang_on_observer(const MapVersion& map, Landmark& landmark);

}  // namespace samewhere::scene
