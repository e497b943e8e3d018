#pragma once

// For the files of this folder: keeps slots of keyframes and observations of landmarks consistent.

#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {

// Assigns the landmark to the keyframe's feature; an invalid one: none.
void set_slot(MapVersion& map, const Observation& observation, core::LandmarkId landmark);

core::LandmarkId shown_at(const MapVersion& map, const Observation& observation);

// Sets descriptor, pyramid level, range and normal of the landmark from this observation.
void set_appearance(const MapVersion& map, Landmark& landmark, const Observation& observation);

// If the anchor of a landmark no longer observes it, anchors it to a keyframe that does; its
// position in the world stays. To be called when a culled keyframe or a withdrawn loop removes
// observations, and before poses move; not for outliers of bundle adjustment.
void anchor_to_observer(const MapVersion& map, Landmark& landmark);
// Anchors the landmark to this keyframe; its position in the world stays.
void anchor_to(const MapVersion& map, Landmark& landmark, core::KeyframeId keyframe);

}  // namespace samewhere::scene
