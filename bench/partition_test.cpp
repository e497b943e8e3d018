#include "partition.hpp"

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>

namespace samewhere::bench {
namespace {

// A map with landmarks and merges only; the merges in order of time.
scene::MapVersion map_of(std::size_t num_landmarks, const std::vector<scene::Merge>& merges) {
  scene::MapVersion map;
  for (std::size_t i = 0; i < num_landmarks; ++i) {
    scene::Landmark landmark;
    landmark.id = core::LandmarkId(i);
    map.landmarks.push_back(landmark);
  }
  for (const auto& made : merges) map.merges.push_back(made);
  return map;
}

scene::Merge merge_of(std::uint64_t from, std::uint64_t to, core::CandidateId cause = {}) {
  return {core::LandmarkId(from), core::LandmarkId(to), cause};
}

TEST(PartitionChange, TheRepresentativeOfAClassDoesNotMatter) {
  const auto before = map_of(5, {merge_of(0, 1), merge_of(1, 2)});
  const auto after = map_of(7, {merge_of(2, 1), merge_of(1, 0), merge_of(0, 6), merge_of(5, 6)});
  const PartitionChange change = partition_change(before, after);
  EXPECT_EQ(change.num_joined, 0);
  EXPECT_EQ(change.num_parted, 0);
}

TEST(PartitionChange, JoinedAndPartedClassesAreCountedSeparately) {
  const auto before = map_of(6, {merge_of(0, 1), merge_of(2, 1)});
  const auto after = map_of(6, {merge_of(0, 3), merge_of(4, 3), merge_of(3, 5)});
  const PartitionChange change = partition_change(before, after);
  EXPECT_EQ(change.num_joined, 3) << "three others with the first";
  EXPECT_EQ(change.num_parted, 2) << "the first, the second and the third from each other";
  ASSERT_EQ(change.joined.size(), 1U);
  EXPECT_EQ(change.joined[0].size(), 4U);
  EXPECT_EQ(partition_change(after, before).num_joined, 2) << "the other way round";
  EXPECT_EQ(partition_change(after, before).num_parted, 3);
}

TEST(PartitionChange, LandmarksAreJoinedThroughLaterOnes) {
  const auto before = map_of(2, {});
  EXPECT_EQ(partition_change(before, map_of(4, {merge_of(0, 3), merge_of(1, 3)})).num_joined, 1);
  EXPECT_EQ(partition_change(before, map_of(4, {merge_of(0, 2), merge_of(1, 3)})).num_joined, 0);
}

TEST(PartitionChange, MergesOfIgnoredLoopsDoNotCount) {
  const core::CandidateId loop(7);
  const auto before = map_of(4, {});
  const auto after = map_of(4, {merge_of(0, 1, loop), merge_of(2, 3)});
  EXPECT_EQ(partition_change(before, after).num_joined, 2);
  EXPECT_EQ(partition_change(before, after, {loop}).num_joined, 1);
}

TEST(PartitionChange, ASmallerMapIsNotALaterVersion) {
  EXPECT_THROW(partition_change(map_of(2, {}), map_of(1, {})), core::ContractError);
}

}  // namespace
}  // namespace samewhere::bench
