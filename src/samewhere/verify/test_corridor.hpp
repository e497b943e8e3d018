#pragma once

#include <optional>

#include <samewhere/features/features.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/verify/measure_competing.hpp>
#include <samewhere/verify/measure_odometry.hpp>

// A map for tests of claims against odometry.

namespace samewhere::verify {

inline core::KeyframeId keyframe_id(int i) {
  return core::KeyframeId(static_cast<std::uint64_t>(i));
}

// A straight corridor of keyframes one metre apart, 5 cm and 0.05 rad of drift from each to the
// next.
inline scene::MapVersion corridor(int count, const features::View& view = features::View{}) {
  scene::Edit edit;
  const core::Rigid3 step{Eigen::Quaterniond::Identity(), {0, 0, 1}};
  core::Rigid3 pose;
  for (int i = 0; i < count; ++i) {
    scene::Keyframe keyframe;
    keyframe.id = keyframe_id(i);
    keyframe.world_from_body = pose;
    keyframe.view = view;
    if (view.features) keyframe.slots.resize(static_cast<std::size_t>(view.features->size()));
    if (i > 0) keyframe.odometry = {keyframe_id(i - 1), step, 400.0 * core::Matrix6d::Identity()};
    edit.keyframes.push_back(keyframe);
    pose = pose * step;
  }
  return apply(scene::MapVersion{}, edit);
}

inline scene::LoopEdge claim(int query, int match, const core::Rigid3& match_from_query) {
  scene::LoopEdge loop;
  loop.query = keyframe_id(query);
  loop.match = keyframe_id(match);
  loop.match_from_query = match_from_query;
  loop.information = loop_information({});
  return loop;
}

// A loop that is so far beside what odometry says.
inline scene::LoopEdge loop_beside(int query, int match, double metres) {
  return claim(query, match,
               {Eigen::Quaterniond::Identity(), {metres, 0.0, 1.0 * (query - match)}});
}

// What this map says of a claim.
class TestDrift {
 public:
  explicit TestDrift(const scene::MapVersion& map, const Config& config = {},
                     const ScaleErrors& scale = {})
      : map_(map), config_(config), drift_(map_, odometry_, scale, config_) {}
  TestDrift(const TestDrift&) = delete;
  TestDrift& operator=(const TestDrift&) = delete;

  core::OdometryEvidence odometry(const scene::LoopEdge& claim) {
    return measure_odometry(drift_, claim);
  }
  std::optional<scene::DriftSample> sample(const scene::LoopEdge& claim) {
    return measure_drift(drift_, claim);
  }
  std::optional<core::CompetingLoopEvidence> competing_loop(const scene::LoopEdge& claim) {
    return measure_competing_loop(drift_, claim);
  }
  std::optional<core::CompetingPlaceEvidence> competing_place(const scene::LoopEdge& claim,
                                                              const scene::LoopEdge& other) {
    return measure_competing_place(drift_, claim, other);
  }

 private:
  scene::MapVersion map_;
  Config config_;
  OdometryTree odometry_;
  MapDrift drift_;
};

}  // namespace samewhere::verify
