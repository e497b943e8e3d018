#pragma once

#include <algorithm>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {

// All that the map says of which landmarks are one and what shows them, without poses.
struct Partition {
  std::vector<std::vector<core::LandmarkId>> slots;
  std::vector<std::vector<std::tuple<core::KeyframeId, int, core::CandidateId>>> observations;
  std::vector<core::LandmarkId> merged_into;
  std::vector<bool> is_culled;
  bool operator==(const Partition&) const = default;
};

inline Partition partition_of(const MapVersion& map) {
  Partition partition;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    partition.slots.push_back(map.keyframes[i].slots);
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    const Landmark& landmark = map.landmarks[i];
    auto& observations = partition.observations.emplace_back();
    for (const auto& o : landmark.observations)
      observations.emplace_back(o.keyframe, o.slot, o.cause);
    std::sort(observations.begin(), observations.end());
    partition.merged_into.push_back(landmark.merged_into);
    partition.is_culled.push_back(landmark.is_culled);
  }
  return partition;
}

// Which landmark stands for each.
inline std::vector<core::LandmarkId> survivors(const MapVersion& map, std::size_t num_landmarks) {
  std::vector<core::LandmarkId> ids;
  for (std::size_t i = 0; i < num_landmarks; ++i)
    ids.push_back(survivor_of(map, core::LandmarkId(i)).id);
  return ids;
}

// Per landmark the first that is one with it.
inline std::vector<std::size_t> classes(const MapVersion& map, std::size_t num_landmarks) {
  const auto ids = survivors(map, num_landmarks);
  std::vector<std::size_t> firsts;
  for (const auto& id : ids)
    firsts.push_back(static_cast<std::size_t>(std::find(ids.begin(), ids.end(), id) - ids.begin()));
  return firsts;
}

inline void expect_slots_and_observations_agree(const MapVersion& map) {
  std::size_t num_shown = 0;
  std::size_t num_observations = 0;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    for (const auto& id : map.keyframes[i].slots) num_shown += id.is_valid() ? 1 : 0;
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    if (!is_live(map.landmarks[i])) continue;
    num_observations += map.landmarks[i].observations.size();
    EXPECT_TRUE(is_live(map.at(map.landmarks[i].anchor))) << "landmark " << i;
    for (const auto& o : map.landmarks[i].observations) {
      const Keyframe& keyframe = map.at(o.keyframe);
      EXPECT_TRUE(is_live(keyframe));
      EXPECT_EQ(keyframe.slots[static_cast<std::size_t>(o.slot)], map.landmarks[i].id);
    }
  }
  EXPECT_EQ(num_shown, num_observations);
}

}  // namespace samewhere::scene
