#include <algorithm>
#include <set>
#include <utility>

#include <samewhere/correct/loop_corrector.hpp>
#include <samewhere/map/local_bundle.hpp>
#include <samewhere/map/mapper.hpp>
#include <samewhere/map/part.hpp>
#include <samewhere/pipeline/soft_odometry.hpp>
#include <samewhere/pipeline/withdrawal.hpp>
#include <samewhere/track/tracker.hpp>

namespace samewhere::pipeline {
namespace {

using scene::MapVersion;

// They show something else, or lost what a bundle had found.
std::set<core::KeyframeId> changed_keyframes(const MapVersion& before, const MapVersion& after) {
  std::set<core::KeyframeId> changed;
  for (std::size_t i = 0; i < before.keyframes.size(); ++i) {
    const scene::Keyframe& was = before.keyframes[i];
    const scene::Keyframe& is = after.keyframes[i];
    const bool was_refined = was.refined_parent_from_keyframe.has_value();
    const bool is_refined = is.refined_parent_from_keyframe.has_value();
    if (is_live(is) && (is.slots != was.slots || was_refined != is_refined)) changed.insert(is.id);
  }
  return changed;
}

constexpr int kRounds = 2;  // of bundle adjustment, the second with re-matched landmarks
constexpr std::size_t kMaxTogether = 60;  // more make a bundle slow

// All at once, since fixed neighbours would be as wrong as the keyframes themselves. Too many are
// split, the oldest first, which then constrain the younger ones.
MapVersion bundled(MapVersion map, const std::set<core::KeyframeId>& keyframes,
                   const Config& config) {
  map::BundleSettings settings{config.map, config.features, config.optimize};
  for (auto next = keyframes.begin(); next != keyframes.end();) {
    std::set<core::KeyframeId> together;
    while (next != keyframes.end() && together.size() < kMaxTogether) together.insert(*next++);
    const int num_windows =
        1 + static_cast<int>(together.size()) / std::max(1, config.map.bundle_keyframes);
    settings.map.bundle_observations = num_windows * config.map.bundle_observations;
    const scene::Edit edit =
        map::bundle(map, map::window_of(map, together, settings.map), settings);
    map = apply(std::move(map), edit);
  }
  return map;
}

// Tracked anew from what its parent shows, the keyframe sees again what was far off while poses
// were.
scene::Edit tracked_anew(const MapVersion& map, core::KeyframeId id, const Config& config) {
  scene::Edit edit;
  const scene::Keyframe& keyframe = map.at(id);
  if (!keyframe.odometry) return edit;
  const core::KeyframeId parent = holder_of(map, keyframe.odometry->parent).keyframe;
  const auto local = map::local_map(map, parent, config.map);
  const track::Tracker tracker(
      {config.track, config.features, config.optimize, static_cast<std::uint64_t>(config.seed)});
  const auto found = tracker.track(
      keyframe.view, local, inverse(map.at(parent).world_from_body) * keyframe.world_from_body);
  if (!found) return edit;
  std::set<core::LandmarkId> shown(keyframe.slots.begin(), keyframe.slots.end());
  for (const auto& match : found->matches) {
    const core::LandmarkId landmark = local.landmarks[static_cast<std::size_t>(match.first)];
    const bool is_free = !keyframe.slots[static_cast<std::size_t>(match.second)].is_valid();
    if (is_free && shown.insert(landmark).second)
      edit.sightings.push_back({landmark, {id, match.second, {}}});
  }
  return edit;
}

MapVersion seen_again(MapVersion map, const std::set<core::KeyframeId>& keyframes,
                      const Config& config) {
  for (const core::KeyframeId id : keyframes) {
    const scene::Edit edit = tracked_anew(map, id, config);
    map = apply(std::move(map), edit);
  }
  return map;
}

}  // namespace

MapVersion with_places_parted(const MapVersion& before, MapVersion after, const Config& config) {
  for (const auto& edit : map::part_places(before, after, config.features))
    after = apply(std::move(after), edit);
  const std::set<core::KeyframeId> changed = changed_keyframes(before, after);
  for (int round = 0; round < kRounds; ++round) {
    if (round > 0) after = seen_again(std::move(after), changed, config);
    if (!config.odometry.is_used()) after = bundled(std::move(after), changed, config);
    const scene::Edit poses =
        correct::solve_poses(with_soft_odometry(after, config), config.optimize);
    after = apply(std::move(after), poses);
  }
  return after;
}

MapVersion without_loop(const MapVersion& map, core::CandidateId cause, const Config& config) {
  const auto edit = correct::withdraw_loop(with_soft_odometry(map, config), cause, config.optimize);
  return with_places_parted(map, apply(map, edit), config);
}

}  // namespace samewhere::pipeline
