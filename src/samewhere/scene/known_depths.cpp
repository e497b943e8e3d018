#include <algorithm>
#include <memory>
#include <utility>

#include <samewhere/scene/known_depths.hpp>

namespace samewhere::scene {

features::View with_known_depths(const MapVersion& map, core::KeyframeId id) {
  const Keyframe& keyframe = map.at(id);
  const core::Rigid3 camera_from_world =
      inverse(world_from_body(map, id) * keyframe.view.rig->body_from_camera[0]);
  auto features = std::make_shared<features::Features>(*keyframe.view.features);
  for (std::size_t slot = 0; slot < keyframe.slots.size(); ++slot) {
    features->depth_m[slot] = 0.0F;
    const core::LandmarkId shown = keyframe.slots[slot];
    if (!shown.is_valid()) continue;
    const double depth = (camera_from_world * position_in_world(map, map.at(shown))).z();
    features->depth_m[slot] = static_cast<float>(std::max(0.0, depth));
  }
  features::View view = keyframe.view;
  view.features = std::move(features);
  return view;
}

}  // namespace samewhere::scene
