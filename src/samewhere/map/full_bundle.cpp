#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <samewhere/core/median.hpp>
#include <samewhere/map/full_bundle.hpp>
#include <samewhere/map/seen.hpp>

namespace samewhere::map {
namespace {

using core::KeyframeId;
using core::LandmarkId;
using scene::MapVersion;

// Those that many keyframes see, and from near by: far points hold directions alone.
std::vector<LandmarkId> most_telling_first(const MapVersion& map) {
  std::vector<std::pair<double, LandmarkId>> ranked;
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    const scene::Landmark& landmark = map.landmarks[i];
    const std::size_t num_seen = landmark.observations.size();
    if (!is_live(landmark) || num_seen < 2) continue;
    ranked.emplace_back(-static_cast<double>(num_seen) / landmark.range_m, landmark.id);
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<LandmarkId> ids;
  for (const auto& [score, id] : ranked) ids.push_back(id);
  return ids;
}

struct Choice {
  std::vector<LandmarkId> landmarks;
  std::vector<int> num_seen;  // per keyframe of the map
};

Choice choose_landmarks(const MapVersion& map, const Config& config) {
  Choice choice{{}, std::vector<int>(map.keyframes.size(), 0)};
  const int num_wanted = is_without_depth(map) ? config.full_bundle_observations_without_depth
                                               : config.full_bundle_observations;
  for (const auto& id : most_telling_first(map)) {
    const auto& observations = map.at(id).observations;
    const auto wants_more = [&](const scene::Observation& o) {
      return choice.num_seen[o.keyframe.index()] < num_wanted;
    };
    if (std::count_if(observations.begin(), observations.end(), wants_more) < 2) continue;
    for (const auto& o : observations) ++choice.num_seen[o.keyframe.index()];
    choice.landmarks.push_back(id);
  }
  std::sort(choice.landmarks.begin(), choice.landmarks.end());
  return choice;
}

// By how much lengths around keyframes grew: the median over what they see of the landmarks that
// were moved.
void stretch(const MapVersion& map, scene::Edit& edit) {
  constexpr std::size_t kMinLandmarks = 10;
  scene::Edit poses;
  poses.pose_changes = edit.pose_changes;
  const MapVersion moved = apply(map, poses);
  std::map<KeyframeId, std::vector<double>> ratios;
  for (const auto& change : edit.landmark_changes) {
    const scene::Landmark& landmark = map.at(change.landmark);
    const Eigen::Vector3d was = position_in_world(map, landmark);
    const Eigen::Vector3d is = world_from_body(moved, landmark.anchor) * change.position_in_anchor;
    for (const auto& o : landmark.observations) {
      const double distance = (was - map.at(o.keyframe).world_from_body.translation).norm();
      ratios[o.keyframe].push_back((is - moved.at(o.keyframe).world_from_body.translation).norm() /
                                   distance);
    }
  }
  for (auto& change : edit.pose_changes) {
    std::vector<double>& of_keyframe = ratios[change.keyframe];
    if (of_keyframe.size() >= kMinLandmarks) change.scale = *core::median(of_keyframe);
  }
}

// What a full bundle did to keyframes, and to those that hang on them.
class Moves {
 public:
  Moves(const MapVersion& map, const scene::Edit& found) : map_(map) {
    for (const auto& change : found.pose_changes) of_keyframe_[change.keyframe] = change;
  }

  // Its own, or that of the next odometry ancestor that has one.
  std::optional<scene::PoseChange> of(KeyframeId id) const {
    KeyframeId holder = id;
    while (!of_keyframe_.contains(holder)) {
      const auto& odometry = map_.at(holder).odometry;
      if (!odometry) return std::nullopt;
      holder = odometry->parent;
    }
    scene::PoseChange change = of_keyframe_.at(holder);
    if (holder == id) return change;
    // the way from there to here is stretched, too
    const core::Rigid3 old = map_.at(id).world_from_body;
    const core::Rigid3 world_from_holder = world_from_body(map_, holder);
    core::Rigid3 holder_from_body = inverse(world_from_holder) * old;
    holder_from_body.translation *= change.scale;
    change.keyframe = id;
    change.new_from_old = change.new_from_old * world_from_holder * holder_from_body * inverse(old);
    return change;
  }

 private:
  const MapVersion& map_;
  std::map<KeyframeId, scene::PoseChange> of_keyframe_;
};

bool has_same_parent(const scene::Keyframe& a, const scene::Keyframe& b) {
  return a.odometry && b.odometry && a.odometry->parent == b.odometry->parent;
}

bool is_as_it_was(const scene::Landmark& was, const scene::Landmark& is) {
  return is_live(is) && was.anchor == is.anchor && was.position_in_anchor == is.position_in_anchor;
}

void carry_poses(const MapVersion& then, const MapVersion& now, const scene::Edit& found,
                 scene::Edit& edit) {
  const Moves moves(now, found);
  std::map<KeyframeId, core::Rigid3> world_from_body;
  for (std::size_t i = 0; i < now.keyframes.size(); ++i) {
    const scene::Keyframe& keyframe = now.keyframes[i];
    if (!is_live(keyframe)) continue;
    world_from_body[keyframe.id] = keyframe.world_from_body;
    const auto move = moves.of(keyframe.id);
    if (!move) continue;
    world_from_body[keyframe.id] = move->new_from_old * keyframe.world_from_body;
    edit.pose_changes.push_back(*move);
  }
  for (const auto& settlement : found.settled) {
    const scene::Keyframe& keyframe = now.at(settlement.keyframe);
    if (!is_live(keyframe) || !has_same_parent(then.at(keyframe.id), keyframe)) continue;
    edit.settled.push_back({keyframe.id, inverse(world_from_body.at(keyframe.odometry->parent)) *
                                             world_from_body.at(keyframe.id)});
  }
}

void carry_points(const MapVersion& then, const MapVersion& now, const scene::Edit& found,
                  scene::Edit& edit) {
  for (const auto& change : found.landmark_changes)
    if (is_as_it_was(then.at(change.landmark), now.at(change.landmark)))
      edit.landmark_changes.push_back(change);
  for (const auto& removed : found.removed_observations) {
    const scene::Landmark& landmark = now.at(removed.landmark);
    if (is_live(landmark) && is_seen_by(landmark, removed.keyframe))
      edit.removed_observations.push_back(removed);
  }
}

}  // namespace

BundleWindow window_of_all(const MapVersion& map, const Config& config) {
  if (map.keyframes.empty()) return {};
  Choice choice = choose_landmarks(map, config);
  BundleWindow window;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    if (is_live(map.keyframes[i]) && choice.num_seen[i] >= config.full_bundle_min_observations)
      window.free.push_back(map.keyframes[i].id);
  }
  const std::size_t num_fixed = is_without_depth(map) ? 2 : 1;
  if (window.free.size() <= num_fixed) return {};
  const auto first_free = window.free.begin() + static_cast<std::ptrdiff_t>(num_fixed);
  window.fixed.assign(window.free.begin(), first_free);
  window.free.erase(window.free.begin(), first_free);
  window.landmarks = std::move(choice.landmarks);
  if (num_observations(map, window) > config.full_bundle_max_observations) return {};
  return window;
}

int num_observations(const MapVersion& map, const BundleWindow& window) {
  std::set<KeyframeId> taking_part(window.free.begin(), window.free.end());
  taking_part.insert(window.fixed.begin(), window.fixed.end());
  int sum = 0;
  for (const auto& id : window.landmarks)
    for (const auto& o : map.at(id).observations) sum += taking_part.contains(o.keyframe) ? 1 : 0;
  return sum;
}

scene::Edit full_bundle(const MapVersion& map, const BundleWindow& window,
                        const BundleSettings& settings) {
  scene::Edit edit = bundle(map, window, settings);
  edit.settled = std::exchange(edit.refinements, {});
  if (!window.free.empty() && is_without_depth(map)) stretch(map, edit);
  return edit;
}

scene::Edit carried_over(const MapVersion& then, const MapVersion& now, const scene::Edit& found) {
  scene::Edit edit;
  carry_poses(then, now, found, edit);
  carry_points(then, now, found, edit);
  return edit;
}

}  // namespace samewhere::map
