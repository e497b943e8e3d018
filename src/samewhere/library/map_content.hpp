#pragma once

#include <memory>

#include <samewhere/map.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere {

struct Map::Content {
  scene::MapVersion map;
  bool is_metric = false;
};

namespace library {

std::shared_ptr<const Map> snapshot(const scene::MapVersion& map, bool is_metric);
// Camera 0 of a keyframe, culled or not.
Pose map_from_camera(const scene::MapVersion& map, const scene::Keyframe& keyframe);

}  // namespace library

}  // namespace samewhere
