#include <algorithm>
#include <cmath>
#include <cstring>

#include <samewhere/map/mapper.hpp>

namespace samewhere::map {
namespace {

double median_depth_m(const features::View& view) {
  std::vector<float> depths;
  for (const float depth_m : view.features->depth_m) {
    if (depth_m > 0.0F) depths.push_back(depth_m);
  }
  if (depths.empty()) return 0.0;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

int num_landmarks(const scene::Keyframe& keyframe) {
  return static_cast<int>(std::count_if(keyframe.slots.begin(), keyframe.slots.end(),
                                        [](const core::LandmarkId& id) { return id.is_valid(); }));
}

// A landmark at feature `slot` of a new keyframe; nothing where depth is unknown.
std::optional<scene::Landmark> new_landmark(const scene::Keyframe& keyframe, int slot,
                                            core::LandmarkId id) {
  const auto point = features::point_in_camera(keyframe.view, slot);
  if (!point) return std::nullopt;
  const core::Rigid3& body_from_camera = keyframe.view.rig->body_from_camera[0];
  const features::Features& features = *keyframe.view.features;
  scene::Landmark landmark;
  landmark.id = id;
  landmark.anchor = keyframe.id;
  landmark.position_in_anchor = body_from_camera * *point;
  landmark.range_m = point->norm();
  landmark.normal_in_anchor =
      (body_from_camera.translation - landmark.position_in_anchor) / landmark.range_m;
  landmark.octave = features.octave[static_cast<std::size_t>(slot)];
  landmark.weight = scene::weight_of_depth(point->z());
  std::memcpy(landmark.descriptor.data(), features.descriptors.ptr(slot),
              landmark.descriptor.size());
  landmark.rgb = features.rgb[static_cast<std::size_t>(slot)];
  landmark.observations = {{keyframe.id, slot}};
  return landmark;
}

// The keyframe, with a landmark at each feature that shows none yet and has depth.
scene::Edit with_new_landmarks(const scene::MapVersion& map, scene::Keyframe keyframe,
                               const std::vector<bool>& is_taken) {
  scene::Edit edit;
  std::uint64_t next = map.landmarks.size();
  for (int slot = 0; slot < keyframe.view.features->size(); ++slot) {
    if (is_taken[static_cast<std::size_t>(slot)]) continue;
    auto landmark = new_landmark(keyframe, slot, core::LandmarkId(next));
    if (!landmark) continue;
    ++next;
    keyframe.slots[static_cast<std::size_t>(slot)] = landmark->id;
    edit.landmarks.push_back(std::move(*landmark));
  }
  edit.keyframes.push_back(std::move(keyframe));
  return edit;
}

scene::Keyframe next_keyframe(const scene::MapVersion& map, const features::View& view,
                              const core::Rigid3& world_from_body) {
  scene::Keyframe keyframe;
  keyframe.id = core::KeyframeId(map.keyframes.size());
  keyframe.world_from_body = world_from_body;
  keyframe.view = view;
  keyframe.slots.resize(static_cast<std::size_t>(view.features->size()));
  return keyframe;
}

}  // namespace

int num_with_depth(const features::View& view) {
  const auto& depth_m = view.features->depth_m;
  return static_cast<int>(
      std::count_if(depth_m.begin(), depth_m.end(), [](float d) { return d > 0.0F; }));
}

bool can_start(const features::View& view, const Config& config) {
  return view.rig->is_calibrated() && num_with_depth(view) >= config.min_landmarks;
}

bool is_worth_keeping(const scene::MapVersion& map, const TrackedView& tracked,
                      const Config& config) {
  if (num_with_depth(tracked.view) < config.min_landmarks) return false;
  const scene::Keyframe& reference = map.at(tracked.pose.reference_keyframe);
  const core::Rigid3& moved = tracked.pose.reference_from_frame;
  const bool is_far =
      moved.translation.norm() > config.max_move_ratio * median_depth_m(tracked.view);
  const bool is_turned = core::angle_rad(moved.rotation) > config.max_turn_rad;
  const bool has_lost_sight = static_cast<double>(tracked.landmarks.size()) <
                              config.min_tracked_ratio * num_landmarks(reference);
  return is_far || is_turned || has_lost_sight;
}

scene::Edit start_map(const scene::MapVersion& map, const features::View& view,
                      const core::Rigid3& world_from_body) {
  scene::Keyframe keyframe = next_keyframe(map, view, world_from_body);
  return with_new_landmarks(map, std::move(keyframe),
                            std::vector<bool>(static_cast<std::size_t>(view.features->size())));
}

scene::Edit add_keyframe(const scene::MapVersion& map, const TrackedView& tracked) {
  const core::FramePose& pose = tracked.pose;
  scene::Keyframe keyframe =
      next_keyframe(map, tracked.view,
                    map.at(pose.reference_keyframe).world_from_body * pose.reference_from_frame);
  keyframe.odometry = {pose.reference_keyframe, pose.reference_from_frame, pose.information};
  std::vector<bool> is_taken(keyframe.slots.size(), false);
  for (const auto& [feature, landmark] : tracked.landmarks)
    is_taken[static_cast<std::size_t>(feature)] = true;

  scene::Edit edit = with_new_landmarks(map, keyframe, is_taken);
  for (const auto& [feature, landmark] : tracked.landmarks) {
    edit.sightings.push_back({landmark, {keyframe.id, feature}});
  }
  return edit;
}

}  // namespace samewhere::map
