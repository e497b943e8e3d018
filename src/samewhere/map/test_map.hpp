#pragma once

// For tests: maps of the points of a test world, made by the functions that the pipeline calls.

#include <algorithm>
#include <cstring>
#include <vector>

#include <samewhere/features/test_world.hpp>
#include <samewhere/map/mapper.hpp>

namespace samewhere::map {

// Overlooked in a view: nothing.
constexpr auto kNone = [](core::LandmarkId) { return false; };

// The view as tracking would hand it over: every feature whose point is a landmark of the map shows
// it, but for those that `is_overlooked` names by id.
template <class IsOverlooked>
scene::TrackedView test_tracked(const scene::MapVersion& map, const features::View& view,
                                const core::Rigid3& world_from_body,
                                const IsOverlooked& is_overlooked) {
  scene::TrackedView tracked{view, {}, {}};
  const scene::Keyframe& reference = map.keyframes.back();
  tracked.pose.reference_keyframe = reference.id;
  tracked.pose.reference_from_frame = inverse(reference.world_from_body) * world_from_body;
  cv::Mat descriptors(0, 32, CV_8U);
  std::vector<core::LandmarkId> ids;
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    const scene::Landmark& landmark = map.landmarks[i];
    if (!is_live(landmark) || is_overlooked(landmark.id)) continue;
    cv::Mat row(1, 32, CV_8U);
    std::memcpy(row.ptr(0), landmark.descriptor.data(), landmark.descriptor.size());
    descriptors.push_back(row);
    ids.push_back(landmark.id);
  }
  for (const auto& match : features::match_pair(descriptors, view.features->descriptors, {}))
    tracked.landmarks.emplace_back(match.second, ids[static_cast<std::size_t>(match.first)]);
  return tracked;
}

inline core::Rigid3 test_walk(int i) {
  return {core::exp_so3({0.0, 0.02 * i, 0.0}), {0.12 * i, 0.0, 0.03 * i}};
}

// A walk of keyframes, each `pose_error` (metres, radians) away from the truth but for the first,
// which see the world with depth.
inline scene::MapVersion test_map(const features::TestWorld& world, int num_keyframes,
                                  double pose_error = 0.0) {
  core::Random random(2);
  scene::MapVersion map;
  map = apply(map, start_map(map, features::test_view(world, 0, {}), {}));
  for (int i = 1; i < num_keyframes; ++i) {
    core::Vector6d error;
    for (int k = 0; k < 6; ++k) error(k) = pose_error * random.gaussian();
    const features::View view = features::test_view(world, i, test_walk(i));
    map =
        apply(map, add_keyframe(map, test_tracked(map, view, test_walk(i) * core::exp_r3so3(error),
                                                  [](core::LandmarkId) { return false; })));
  }
  return map;
}

// How far the keyframe that is worst off lies from where the walk was (metres and radians as one
// vector).
inline double worst_error(const scene::MapVersion& map) {
  double worst = 0.0;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    if (!is_live(map.keyframes[i])) continue;
    const core::Rigid3 error =
        inverse(test_walk(static_cast<int>(i))) * world_from_body(map, core::KeyframeId(i));
    worst = std::max(worst, core::log_r3so3(error).norm());
  }
  return worst;
}

}  // namespace samewhere::map
