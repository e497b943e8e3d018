#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/median.hpp>
#include <samewhere/map/mapper.hpp>

namespace samewhere::map {
namespace {

double median_depth_m(const features::View& view) {
  std::vector<float> depths;
  for (const float depth_m : view.features->depth_m) {
    if (depth_m > 0.0F) depths.push_back(depth_m);
  }
  return core::median(std::move(depths)).value_or(0.0F);
}

// Landmarks that a second keyframe shows too. What only one has shown may never be found again: it
// says nothing of how much of the reference is still in sight. Of the first keyframe all.
int num_proven_landmarks(const scene::MapVersion& map, const scene::Keyframe& keyframe) {
  const std::size_t min_observations = map.keyframes.size() > 2 ? 2 : 1;
  return static_cast<int>(
      std::count_if(keyframe.slots.begin(), keyframe.slots.end(), [&](const core::LandmarkId& id) {
        return id.is_valid() && map.at(id).observations.size() >= min_observations;
      }));
}

// Nothing: the map has no keyframe of this session yet.
std::optional<double> first_stamp_s(const scene::MapVersion& map, std::uint16_t session) {
  std::optional<double> first_s;
  for (std::size_t i = map.keyframes.size(); i-- > 0;) {
    if (map.keyframes[i].view.frame.session() != session) break;
    first_s = map.keyframes[i].view.stamp_s;
  }
  return first_s;
}

// A camera that stays in one room sees it all again within minutes; shorter recordings are as if
// there were no such rule.
constexpr double kKnownAfter_s = 120.0;
constexpr int kMinKnown = 75;  // landmarks: by so many a pose is sure

// Whether the map has known what the view shows for so long that one more keyframe says nothing
// new: of the landmarks that it shows most, and enough, were seen by two keyframes, one of them
// before that. Stamps of an earlier session do not compare: it counts as the begin of this one.
bool is_long_known(const scene::MapVersion& map, const scene::TrackedView& tracked) {
  const std::uint16_t session = tracked.view.frame.session();
  const auto session_begin_s = first_stamp_s(map, session);
  const double latest_s = tracked.view.stamp_s - kKnownAfter_s;
  if (!session_begin_s || *session_begin_s > latest_s) return false;
  const auto is_old = [&](const scene::Observation& o) {
    const features::View& view = map.at(o.keyframe).view;
    return view.frame.session() != session || view.stamp_s <= latest_s;
  };
  const auto num_known = static_cast<int>(
      std::count_if(tracked.landmarks.begin(), tracked.landmarks.end(), [&](const auto& shown) {
        const auto& observations = map.at(shown.second).observations;
        return observations.size() >= 2 &&
               std::any_of(observations.begin(), observations.end(), is_old);
      }));
  const auto num_tracked = static_cast<int>(tracked.landmarks.size());
  return num_known >= kMinKnown && 2 * num_known > num_tracked;
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

bool can_keep(const scene::MapVersion& map, const features::View& view, const Config& config) {
  return is_without_depth(map) || num_with_depth(view) >= config.min_landmarks;
}

scene::LocalMap local_map(const scene::MapVersion& map, core::KeyframeId reference,
                          const Config& config) {
  return build_local_map(map, reference, {config.max_neighbours, config.near_neighbours});
}

double median_landmark_depth(const scene::MapVersion& map, const scene::TrackedView& tracked) {
  const core::Rigid3 camera_from_world =
      inverse(world_from_frame(map, tracked.pose) * tracked.view.rig->body_from_camera[0]);
  std::vector<double> depths;
  for (const auto& [feature, landmark] : tracked.landmarks)
    depths.push_back((camera_from_world * position_in_world(map, map.at(landmark))).z());
  return core::median(std::move(depths)).value_or(0.0);
}

bool is_worth_keeping(const scene::MapVersion& map, const scene::TrackedView& tracked,
                      const Config& config) {
  if (!can_keep(map, tracked.view, config)) return false;
  const bool has_depth = !is_without_depth(map);
  const double depth_m =
      has_depth ? median_depth_m(tracked.view) : median_landmark_depth(map, tracked);
  const double max_move_ratio =
      has_depth ? config.max_move_ratio : config.max_move_ratio_without_depth;
  const double min_tracked_ratio =
      has_depth ? config.min_tracked_ratio : config.min_tracked_ratio_without_depth;
  const core::Rigid3 moved = reference_from_frame(map, tracked.pose);
  const bool is_far = moved.translation.norm() > max_move_ratio * depth_m;
  const bool is_turned = core::angle_rad(moved.rotation) > config.max_turn_rad;
  const int num_in_reference = num_proven_landmarks(map, map.at(tracked.pose.reference_keyframe));
  const auto num_tracked = static_cast<int>(tracked.landmarks.size());
  const bool has_lost_sight = num_tracked < min_tracked_ratio * num_in_reference;
  const bool shows_new = is_far || is_turned || has_lost_sight || num_tracked < config.min_tracked;
  return shows_new && !is_long_known(map, tracked);
}

scene::Edit start_map(const scene::MapVersion& map, const features::View& view,
                      const core::Rigid3& world_from_body) {
  scene::Keyframe keyframe = next_keyframe(map, view, world_from_body);
  return with_new_landmarks(map, std::move(keyframe),
                            std::vector<bool>(static_cast<std::size_t>(view.features->size())));
}

scene::Edit start_map(const scene::MapVersion& map, const ViewPair& pair) {
  const core::Rigid3& body_from_camera = pair.first.rig->body_from_camera[0];
  const core::Rigid3 world_from_second =
      body_from_camera * pair.first_from_second * inverse(pair.second.rig->body_from_camera[0]);
  scene::Edit edit;
  edit.keyframes = {next_keyframe(map, pair.first, core::Rigid3{}),
                    next_keyframe(map, pair.second, world_from_second)};
  const core::KeyframeId first_id = edit.keyframes.front().id;
  scene::Keyframe& second = edit.keyframes.back();
  second.id = core::KeyframeId(first_id.value() + 1);
  second.odometry = {first_id, world_from_second, pair.information};
  for (std::size_t i = 0; i < pair.matches.size(); ++i) {
    scene::Landmark landmark;
    landmark.id = core::LandmarkId(map.landmarks.size() + i);
    landmark.anchor = first_id;
    landmark.position_in_anchor = body_from_camera * pair.points_in_first[i];
    landmark.rgb = pair.first.features->rgb[static_cast<std::size_t>(pair.matches[i].first)];
    edit.sightings.push_back({landmark.id, {first_id, pair.matches[i].first}});
    edit.sightings.push_back({landmark.id, {second.id, pair.matches[i].second}});
    edit.landmarks.push_back(std::move(landmark));
  }
  return edit;
}

scene::Edit give_up(const scene::MapVersion& map) {
  scene::Edit edit;
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    if (is_live(map.landmarks[i])) edit.culled_landmarks.push_back(map.landmarks[i].id);
  }
  return edit;
}

scene::Edit add_keyframe(const scene::MapVersion& map, const scene::TrackedView& tracked) {
  const core::FramePose& pose = tracked.pose;
  scene::Keyframe keyframe = next_keyframe(map, tracked.view, world_from_frame(map, pose));
  // a reference that was culled since then hangs on another: the edge goes there
  const scene::Holder holder = holder_of(map, pose.reference_keyframe);
  keyframe.odometry = {holder.keyframe,
                       holder.holder_from_keyframe * reference_from_frame(map, pose),
                       pose.information};
  keyframe.log_scale = map.at(holder.keyframe).log_scale;
  std::vector<bool> is_taken(keyframe.slots.size(), false);
  for (const int feature : tracked.passing) is_taken[static_cast<std::size_t>(feature)] = true;
  std::vector<scene::Sighting> sightings;
  std::set<core::LandmarkId> seen;
  for (const auto& [feature, landmark] : tracked.landmarks) {
    const scene::Landmark& survivor = survivor_of(map, landmark);
    if (survivor.is_culled || !seen.insert(survivor.id).second) continue;
    is_taken[static_cast<std::size_t>(feature)] = true;
    sightings.push_back({survivor.id, {keyframe.id, feature}});
  }
  scene::Edit edit = with_new_landmarks(map, std::move(keyframe), is_taken);
  edit.sightings = std::move(sightings);
  return edit;
}

}  // namespace samewhere::map
