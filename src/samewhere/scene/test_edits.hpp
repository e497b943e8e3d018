#pragma once

#include <algorithm>
#include <cmath>
#include <set>

#include <samewhere/core/random.hpp>
#include <samewhere/features/test_world.hpp>
#include <samewhere/scene/map_file.hpp>

namespace samewhere::scene {

inline core::Rigid3 random_pose(core::Random& random) {
  core::Vector6d tangent;
  for (double& value : tangent) value = random.gaussian();
  return core::exp_r3so3(tangent);
}

inline core::Matrix6d random_information(core::Random& random) {
  core::Matrix6d root;
  for (double& value : root.reshaped()) value = random.gaussian();
  return root * root.transpose() + core::Matrix6d::Identity();
}

// Edits that say everything an edit can say, at random.
class RandomEdits {
 public:
  explicit RandomEdits(std::uint64_t seed)
      : random_(seed), world_(features::test_world(seed, 60)) {}

  Edit next(const MapVersion& map) {
    Edit edit;
    touched_.clear();
    if (map.loops.size() > 1 && random_.index(4) == 0) {
      withdraw_loop(map, edit);
      add_keyframe(map, edit, false);
      return edit;
    }
    add_keyframe(map, edit, true);
    move_keyframes(map, edit);
    if (map.keyframes.size() > 1 && random_.index(3) == 0) add_loop(map, edit);
    for (std::size_t i = 0; i < map.landmarks.size(); ++i) change_landmark(map, i, edit);
    if (map.keyframes.size() > 3 && random_.index(3) == 0) cull_keyframe(map, edit);
    return edit;
  }

 private:
  core::KeyframeId any_keyframe(const MapVersion& map) {
    return core::KeyframeId(random_.index(map.keyframes.size()));
  }

  void add_keyframe(const MapVersion& map, Edit& edit, bool sees_known) {
    Keyframe keyframe;
    keyframe.id = core::KeyframeId(map.keyframes.size());
    keyframe.world_from_body = random_pose(random_);
    keyframe.view = features::test_view(world_, static_cast<int>(map.keyframes.size()),
                                        keyframe.world_from_body);
    keyframe.slots.resize(static_cast<std::size_t>(keyframe.view.features->size()));
    if (!map.keyframes.empty())
      keyframe.odometry = {any_keyframe(map), random_pose(random_), random_information(random_)};
    std::set<std::uint64_t> seen;
    for (std::size_t slot = 0; slot < keyframe.slots.size(); ++slot) {
      const Observation observation{keyframe.id, static_cast<int>(slot), any_cause()};
      const std::uint64_t kind = random_.index(3);
      if (kind == 0) {
        edit.landmarks.push_back(new_landmark(map, edit, observation));
        keyframe.slots[slot] = edit.landmarks.back().id;
      } else if (kind == 1 && sees_known && !map.landmarks.empty()) {
        const std::uint64_t known = random_.index(map.landmarks.size());
        if (is_live(map.landmarks[known]) && seen.insert(known).second)
          edit.sightings.push_back({core::LandmarkId(known), observation});
      }
    }
    edit.keyframes.push_back(keyframe);
  }

  Landmark new_landmark(const MapVersion& map, const Edit& edit, const Observation& observation) {
    Landmark landmark;
    landmark.id = core::LandmarkId(map.landmarks.size() + edit.landmarks.size());
    landmark.anchor = observation.keyframe;
    landmark.position_in_anchor = {random_.gaussian(), random_.gaussian(), random_.gaussian()};
    landmark.normal_in_anchor = {-0.0, 1e-300, 1.0};
    landmark.range_m = random_.uniform();
    landmark.octave = static_cast<int>(random_.index(8));
    landmark.weight = random_.uniform();
    for (auto& byte : landmark.descriptor) byte = static_cast<std::uint8_t>(random_.index(256));
    landmark.rgb = {1, 2, static_cast<std::uint8_t>(random_.index(256))};
    landmark.observations = {observation};
    return landmark;
  }

  void move_keyframes(const MapVersion& map, Edit& edit) {
    for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
      const Keyframe& keyframe = map.keyframes[i];
      if (is_live(keyframe) && random_.index(4) == 0)
        edit.pose_changes.push_back({keyframe.id, random_pose(random_),
                                     random_.uniform() < 0.5 ? 1.0 : 0.5 + random_.uniform()});
      if (keyframe.odometry && random_.index(4) == 0)
        edit.refinements.push_back({keyframe.id, random_pose(random_)});
      if (keyframe.odometry && random_.index(8) == 0)
        edit.settled.push_back({keyframe.id, random_pose(random_)});
    }
  }

  // Moved, merged into the next one, culled, or no longer seen by one: at most one of these.
  void change_landmark(const MapVersion& map, std::size_t i, Edit& edit) {
    const Landmark& landmark = map.landmarks[i];
    const bool is_last = i + 1 == map.landmarks.size();
    if (!is_live(landmark) || touched_.contains(landmark.id)) return;
    const std::uint64_t kind = random_.index(12);
    if (kind == 0) edit.landmark_changes.push_back({landmark.id, {random_.gaussian(), 0.0, 1.0}});
    if (kind == 1 && !is_last && is_live(map.landmarks[i + 1])) {
      edit.merges.push_back({landmark.id, map.landmarks[i + 1].id, any_cause()});
      touched_ = {map.landmarks[i + 1].id};
    }
    if (kind == 2) edit.culled_landmarks.push_back(landmark.id);
    if (kind == 3 && landmark.observations.size() > 1)
      edit.removed_observations.push_back({landmark.id, landmark.observations[0].keyframe});
  }

  void cull_keyframe(const MapVersion& map, Edit& edit) {
    const core::KeyframeId id = any_keyframe(map);
    const auto holds = [&](const LoopEdge& loop) { return loop.query == id || loop.match == id; };
    const bool is_held = std::any_of(map.loops.begin(), map.loops.end(), holds);
    if (!is_held && map.at(id).odometry && is_live(map.at(id)) && edit.loops.empty())
      edit.culled_keyframes.push_back(id);
  }

  void add_loop(const MapVersion& map, Edit& edit) {
    const core::KeyframeId query = any_keyframe(map);
    const core::KeyframeId match = any_keyframe(map);
    if (query == match || !is_live(map.at(query)) || !is_live(map.at(match))) return;
    const core::CandidateId cause(map.number);
    auto& loops = random_.index(3) == 0 ? edit.suspended_loops : edit.loops;
    loops.push_back({query, match, random_pose(random_), random_information(random_), cause});
    causes_.push_back(cause);
  }

  // The last loop, with all that it caused; it is suspended.
  static void withdraw_loop(const MapVersion& map, Edit& edit) {
    edit.withdrawn_loops = {map.loops.back().cause};
    edit.suspended_loops = {map.loops.back()};
  }

  // One of the loops, or none.
  core::CandidateId any_cause() {
    if (causes_.empty() || random_.index(2) == 0) return {};
    return causes_[random_.index(causes_.size())];
  }

  core::Random random_;
  features::TestWorld world_;
  std::vector<core::CandidateId> causes_;
  std::set<core::LandmarkId> touched_;  // merged into by this edit
};

inline std::vector<float> unit_vector(core::Random& random) {
  const double angle_rad = random.gaussian();
  return {static_cast<float>(std::cos(angle_rad)), static_cast<float>(std::sin(angle_rad))};
}

inline MapExtras extras_of(const MapVersion& map, core::Random& random) {
  const features::View& view = map.keyframes.back().view;
  core::FramePose pose{.frame = view.frame, .stamp_s = view.stamp_s, .is_measured = true};
  pose.reference_keyframe = map.keyframes.back().id;
  pose.reference_from_frame = random_pose(random);
  pose.information = random_information(random);
  pose.num_inliers = static_cast<int>(random.index(500));
  MapExtras extras;
  extras.frames = {pose};
  extras.descriptors = {{view.frame, unit_vector(random), 77}};
  extras.ledger = {R"({"query": )" + std::to_string(view.frame.index()) + "}"};
  return extras;
}

}  // namespace samewhere::scene
