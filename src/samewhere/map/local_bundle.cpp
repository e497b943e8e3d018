#include <algorithm>
#include <map>
#include <set>

#include <samewhere/core/errors.hpp>
#include <samewhere/features/stereo.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/map/local_bundle.hpp>
#include <samewhere/map/seen.hpp>

namespace samewhere::map {
namespace {

using core::KeyframeId;
using core::LandmarkId;
using scene::MapVersion;

std::set<KeyframeId> free_keyframes(const MapVersion& map, KeyframeId keyframe,
                                    const Config& config) {
  const int max_free = has_depth(map.at(keyframe).view) ? config.bundle_keyframes
                                                        : config.bundle_keyframes_without_depth;
  std::set<KeyframeId> free = {keyframe};
  for (const auto& covisible : covisible_keyframes(map, keyframe)) {
    if (static_cast<int>(free.size()) >= max_free) break;
    if (covisible.num_shared >= config.min_shared) free.insert(covisible.keyframe);
  }
  return free;
}

// Landmarks of the free keyframes that another keyframe observes, too; most observations first, up
// to the limit of the bundle.
std::vector<LandmarkId> bundled_landmarks(const MapVersion& map, const std::set<KeyframeId>& free,
                                          int max_observations) {
  std::set<LandmarkId> seen;
  for (const auto& id : free) {
    for (const auto& landmark : map.at(id).slots) {
      if (landmark.is_valid()) seen.insert(landmark);
    }
  }
  const auto num_seen = [&](LandmarkId id) {
    return static_cast<int>(map.at(id).observations.size());
  };
  std::vector<LandmarkId> ranked(seen.begin(), seen.end());
  std::stable_sort(ranked.begin(), ranked.end(),
                   [&](LandmarkId a, LandmarkId b) { return num_seen(a) > num_seen(b); });
  std::vector<LandmarkId> chosen;
  int num_observations = 0;
  for (const auto& id : ranked) {
    num_observations += num_seen(id);
    if (num_seen(id) < 2 || num_observations > max_observations) break;
    chosen.push_back(id);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

// Those outside that see most of the landmarks; ties go to the younger.
std::vector<KeyframeId> fixed_keyframes(const MapVersion& map, const std::set<KeyframeId>& free,
                                        const std::vector<LandmarkId>& landmarks, int max_fixed) {
  std::map<KeyframeId, int> num_seen;
  for (const auto& id : landmarks) {
    for (const auto& o : map.at(id).observations) {
      if (!free.contains(o.keyframe)) ++num_seen[o.keyframe];
    }
  }
  std::vector<std::pair<int, KeyframeId>> ranked;
  for (const auto& [id, count] : num_seen) ranked.emplace_back(count, id);
  std::sort(ranked.rbegin(), ranked.rend());
  std::vector<KeyframeId> fixed;
  for (const auto& [count, id] : ranked) {
    if (static_cast<int>(fixed.size()) < max_fixed) fixed.push_back(id);
  }
  std::sort(fixed.begin(), fixed.end());
  return fixed;
}

// The problem and what its positions stand for.
struct Problem {
  optimize::BundleProblem bundle;
  std::vector<KeyframeId> keyframes;
  std::vector<LandmarkId> landmarks;
  std::vector<scene::RemovedObservation> names;  // of the observations
};

Problem problem_of(const MapVersion& map, const BundleWindow& window,
                   const features::Config& config) {
  Problem problem{{}, window.free, window.landmarks, {}};
  problem.keyframes.insert(problem.keyframes.end(), window.fixed.begin(), window.fixed.end());
  std::map<KeyframeId, int> camera_of;
  for (const auto& id : problem.keyframes) {
    const scene::Keyframe& keyframe = map.at(id);
    camera_of[id] = static_cast<int>(camera_of.size());
    problem.bundle.cameras.push_back({camera_from_world(map, keyframe),
                                      geometry::pinhole(keyframe.view.rig->cameras[0]),
                                      features::baseline_m(*keyframe.view.rig, config),
                                      camera_of[id] >= static_cast<int>(window.free.size())});
  }
  for (const auto& id : window.landmarks) {
    const scene::Landmark& landmark = map.at(id);
    const auto point = static_cast<int>(problem.bundle.points_in_world.size());
    problem.bundle.points_in_world.push_back(position_in_world(map, landmark));
    for (const auto& o : landmark.observations) {
      const auto camera = camera_of.find(o.keyframe);
      if (camera == camera_of.end()) continue;
      problem.bundle.observations.push_back(
          {camera->second, point, seen_at(map.at(o.keyframe).view, o.slot, config)});
      problem.names.push_back({id, o.keyframe});
    }
  }
  return problem;
}

// Where the free keyframes are by the result; refinements of those whose parent took part.
scene::Edit moved_keyframes(const MapVersion& map, const Problem& problem,
                            const optimize::BundleResult& result) {
  scene::Edit edit;
  std::map<KeyframeId, core::Rigid3> world_from_body;
  for (std::size_t i = 0; i < problem.keyframes.size(); ++i) {
    const scene::Keyframe& keyframe = map.at(problem.keyframes[i]);
    if (problem.bundle.cameras[i].is_fixed) {
      world_from_body[keyframe.id] = keyframe.world_from_body;
      continue;
    }
    const core::Rigid3 found =
        inverse(keyframe.view.rig->body_from_camera[0] * result.camera_from_world[i]);
    world_from_body[keyframe.id] = found;
    edit.pose_changes.push_back({keyframe.id, found * inverse(keyframe.world_from_body)});
  }
  for (const auto& change : edit.pose_changes) {
    const scene::Keyframe& keyframe = map.at(change.keyframe);
    if (!keyframe.odometry) continue;
    const auto parent = world_from_body.find(keyframe.odometry->parent);
    if (parent == world_from_body.end()) continue;
    edit.refinements.push_back(
        {keyframe.id, inverse(parent->second) * world_from_body.at(keyframe.id)});
  }
  return edit;
}

}  // namespace

optimize::BundleProblem bundle_problem(const MapVersion& map, const BundleWindow& window,
                                       const features::Config& config) {
  return problem_of(map, window, config).bundle;
}

BundleWindow window_around(const MapVersion& map, KeyframeId keyframe, const Config& config) {
  return window_of(map, free_keyframes(map, keyframe, config), config);
}

BundleWindow window_of(const MapVersion& map, std::set<KeyframeId> free, const Config& config) {
  core::require(!free.empty(), "a bundle moves a keyframe");
  BundleWindow window;
  window.landmarks = bundled_landmarks(map, free, config.bundle_observations);
  window.fixed = fixed_keyframes(map, free, window.landmarks, config.bundle_fixed_keyframes);
  const std::size_t num_needed = has_depth(map.at(*free.rbegin()).view) ? 1 : 2;
  while (window.fixed.size() < num_needed && free.size() > 1) {
    window.fixed.push_back(*free.begin());
    free.erase(free.begin());
  }
  std::sort(window.fixed.begin(), window.fixed.end());
  window.free.assign(free.begin(), free.end());
  return window;
}

scene::Edit bundle_around(const MapVersion& map, KeyframeId keyframe,
                          const BundleSettings& settings) {
  return bundle(map, window_around(map, keyframe, settings.map), settings);
}

scene::Edit bundle(const MapVersion& map, const BundleWindow& window,
                   const BundleSettings& settings) {
  if (window.fixed.empty()) return {};
  const Problem problem = problem_of(map, window, settings.features);
  const optimize::BundleResult result = solve_bundle(problem.bundle, settings.optimize);

  scene::Edit edit = moved_keyframes(map, problem, result);
  scene::Edit poses;
  poses.pose_changes = edit.pose_changes;
  const MapVersion moved = apply(map, poses);
  for (std::size_t i = 0; i < problem.landmarks.size(); ++i) {
    const scene::Landmark& landmark = map.at(problem.landmarks[i]);
    edit.landmark_changes.push_back({landmark.id, inverse(world_from_body(moved, landmark.anchor)) *
                                                      result.points_in_world[i]});
  }
  for (std::size_t i = 0; i < problem.names.size(); ++i) {
    if (!result.is_inlier[i]) edit.removed_observations.push_back(problem.names[i]);
  }
  return edit;
}

}  // namespace samewhere::map
