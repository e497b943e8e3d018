#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/correct/loop_corrector.hpp>
#include <samewhere/map/cull.hpp>
#include <samewhere/map/fuse.hpp>
#include <samewhere/map/local_bundle.hpp>
#include <samewhere/map/test_map.hpp>
#include <samewhere/pipeline/correction.hpp>

namespace samewhere::pipeline {

// A walk through two rooms, 10 m apart, that look the same to the last point.
class LookAlikeRooms : public testing::Test {
 protected:
  static constexpr std::size_t kPerRoom = 6;  // keyframes, before a loop is closed
  static inline const core::CandidateId kFalseLoop{7};

  // Unless a test asks for it no keyframe is culled: what loops do to the map is plainer to see.
  LookAlikeRooms() {
    config_.map.redundant_ratio = 1.0;
    walk_both();
  }

  void walk_both() {
    map_ = {};
    for (std::size_t i = 0; i < 2 * kPerRoom; ++i) map_ = with_next(map_);
  }

  static core::Rigid3 truth(std::size_t i) {
    const core::Rigid3 second{Eigen::Quaterniond::Identity(), {10.0, 0.0, 1.0}};
    return i < kPerRoom ? map::test_walk(static_cast<int>(i))
                        : second * map::test_walk(static_cast<int>(i - kPerRoom));
  }

  // The next keyframe of the walk. What it knows again are landmarks that a keyframe of its room
  // shows.
  scene::MapVersion with_next(scene::MapVersion map) const {
    const std::size_t i = map.keyframes.size();
    const std::size_t in_room = i < kPerRoom ? i : i - kPerRoom;
    const features::View view =
        features::test_view(world_, static_cast<int>(i), map::test_walk(static_cast<int>(in_room)));
    if (i == 0) return apply(map, map::start_map(map, view, {}));
    core::Random random(core::seed_of(odometry_seed_, "odometry", i));
    core::Vector6d error;
    for (double& value : error) value = (i == kPerRoom ? 0.02 : 0.003) * random.gaussian();
    const core::Rigid3 world_from_body = map.keyframes.back().world_from_body *
                                         inverse(truth(i - 1)) * truth(i) * core::exp_r3so3(error);
    const auto is_overlooked = [&](core::LandmarkId id) {
      const auto& seen = map.at(id).observations;
      return i >= kPerRoom && std::none_of(seen.begin(), seen.end(), [](const auto& o) {
               return o.keyframe.index() >= kPerRoom;
             });
    };
    scene::TrackedView tracked = map::test_tracked(map, view, world_from_body, is_overlooked);
    // between the rooms odometry knows little
    tracked.pose.information = (i == kPerRoom ? 0.1 : 1e4) * core::Matrix6d::Identity();
    map = apply(map, map::add_keyframe(map, tracked));
    return refined(std::move(map));
  }

  scene::MapVersion refined(scene::MapVersion map) const {
    const core::KeyframeId newest = map.keyframes.back().id;
    for (const auto& edit : map::fuse_around(map, newest, config_.map, config_.features))
      map = apply(map, edit);
    map = apply(map,
                map::bundle_around(map, newest, {config_.map, config_.features, config_.optimize}));
    return apply(map, map::cull_around(map, newest, config_.map, config_.features));
  }

  static scene::LoopEdge loop(std::size_t query, std::size_t match,
                              const core::Rigid3& match_from_query, core::CandidateId cause) {
    return {core::KeyframeId(query), core::KeyframeId(match), match_from_query,
            1e3 * core::Matrix6d::Identity(), cause};
  }

  static scene::LoopEdge true_loop(std::size_t query, std::size_t match) {
    return loop(query, match, inverse(truth(match)) * truth(query),
                core::CandidateId(1000 + query));
  }

  // The last keyframe of the second room is the last one of the first, says what they show.
  static scene::LoopEdge false_loop() {
    return loop(2 * kPerRoom - 1, kPerRoom - 1, {}, kFalseLoop);
  }

  scene::MapVersion closed(const scene::MapVersion& before, const scene::LoopEdge& heard) const {
    return with_loop(before, correct::between_holders(before, heard).value(), config_).map;
  }

  std::vector<core::LandmarkId> survivors(const scene::MapVersion& map) const {
    std::vector<core::LandmarkId> ids;
    for (std::size_t i = 0; i < map_.landmarks.size(); ++i)
      ids.push_back(survivor_of(map, core::LandmarkId(i)).id);
    return ids;
  }

  static int num_seen_in_both_rooms(const scene::MapVersion& map) {
    int count = 0;
    for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
      if (!is_live(map.landmarks[i])) continue;
      const auto& seen = map.landmarks[i].observations;
      const auto is_in_first = [](const auto& o) { return o.keyframe.index() < kPerRoom; };
      count += std::any_of(seen.begin(), seen.end(), is_in_first) &&
               !std::all_of(seen.begin(), seen.end(), is_in_first);
    }
    return count;
  }

  static double rmse_m(const scene::MapVersion& map) {
    double sum = 0.0;
    for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
      const core::Rigid3 pose = world_from_body(map, core::KeyframeId(i));
      sum += (pose.translation - truth(i).translation).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(map.keyframes.size()));
  }

  Config config_;
  std::uint64_t odometry_seed_ = 5;
  features::TestWorld world_ = features::test_world(3, 2000);
  scene::MapVersion map_;
};

}  // namespace samewhere::pipeline
