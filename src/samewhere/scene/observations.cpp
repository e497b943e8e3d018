#include <algorithm>
#include <cstring>

#include <samewhere/scene/observations.hpp>

namespace samewhere::scene {

void set_slot(MapVersion& map, const Observation& observation, core::LandmarkId landmark) {
  map.keyframes.edit(observation.keyframe.index())
      .slots[static_cast<std::size_t>(observation.slot)] = landmark;
}

core::LandmarkId shown_at(const MapVersion& map, const Observation& observation) {
  return map.at(observation.keyframe).slots[static_cast<std::size_t>(observation.slot)];
}

void set_appearance(const MapVersion& map, Landmark& landmark, const Observation& observation) {
  const Keyframe& keyframe = map.at(observation.keyframe);
  const features::Features& features = *keyframe.view.features;
  const core::Rigid3 anchor_from_body =
      inverse(world_from_body(map, landmark.anchor)) * keyframe.world_from_body;
  const Eigen::Vector3d eye =
      (anchor_from_body * keyframe.view.rig->body_from_camera[0]).translation -
      landmark.position_in_anchor;
  landmark.range_m = eye.norm();
  landmark.normal_in_anchor = eye.normalized();
  landmark.octave = features.octave[static_cast<std::size_t>(observation.slot)];
  std::memcpy(landmark.descriptor.data(), features.descriptors.ptr(observation.slot),
              landmark.descriptor.size());
}

void anchor_to_observer(const MapVersion& map, Landmark& landmark) {
  const auto& seen = landmark.observations;
  const bool is_held = std::any_of(seen.begin(), seen.end(), [&](const Observation& o) {
    return o.keyframe == landmark.anchor;
  });
  if (!is_held && !seen.empty()) anchor_to(map, landmark, seen.front().keyframe);
}

void anchor_to(const MapVersion& map, Landmark& landmark, core::KeyframeId keyframe) {
  const core::Rigid3 keyframe_from_anchor =
      inverse(world_from_body(map, keyframe)) * world_from_body(map, landmark.anchor);
  landmark.anchor = keyframe;
  landmark.position_in_anchor = keyframe_from_anchor * landmark.position_in_anchor;
  landmark.normal_in_anchor = keyframe_from_anchor.rotation * landmark.normal_in_anchor;
}

}  // namespace samewhere::scene
