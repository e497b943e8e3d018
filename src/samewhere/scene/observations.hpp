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

// A landmark that its anchor sees no longer hangs from now on on a keyframe that does, in its place
// in the world: it moves with those who see it. To be called when a keyframe or a loop takes
// observations along, and before poses move; not for what a bundle finds wrong: the keyframe that
// brought it still answers for it.
void hang_on_observer(const MapVersion& map, Landmark& landmark);
// The same on this keyframe.
void hang_on(const MapVersion& map, Landmark& landmark, core::KeyframeId keyframe);

}  // namespace samewhere::scene
