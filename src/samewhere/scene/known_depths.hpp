#pragma once

#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {

// The keyframe's view, with the depths of the landmarks that it shows in place of what its camera
// measured.
features::View with_known_depths(const MapVersion& map, core::KeyframeId id);

}  // namespace samewhere::scene
