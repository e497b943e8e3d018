#include <gtest/gtest.h>

#include "liar.hpp"
#include "partition.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/map/test_map.hpp>

namespace samewhere::bench {
namespace {

// Landmarks without anything but their merges, in the order in which they were made.
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

TEST(PartitionChange, WhoStandsForAClassIsNothing) {
  const auto before = map_of(5, {merge_of(0, 1), merge_of(1, 2)});
  const auto after = map_of(7, {merge_of(2, 1), merge_of(1, 0), merge_of(0, 6), merge_of(5, 6)});
  const PartitionChange change = partition_change(before, after);
  EXPECT_EQ(change.num_joined, 0);
  EXPECT_EQ(change.num_parted, 0);
}

TEST(PartitionChange, WhatWasTwoAndWhatWasOneIsCountedApart) {
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

TEST(PartitionChange, LandmarksAreOneThroughYoungerOnesToo) {
  const auto before = map_of(2, {});
  EXPECT_EQ(partition_change(before, map_of(4, {merge_of(0, 3), merge_of(1, 3)})).num_joined, 1);
  EXPECT_EQ(partition_change(before, map_of(4, {merge_of(0, 2), merge_of(1, 3)})).num_joined, 0);
}

TEST(PartitionChange, WhatOtherLoopsMergedDoesNotCountIfToldSo) {
  const core::CandidateId loop(7);
  const auto before = map_of(4, {});
  const auto after = map_of(4, {merge_of(0, 1, loop), merge_of(2, 3)});
  EXPECT_EQ(partition_change(before, after).num_joined, 2);
  EXPECT_EQ(partition_change(before, after, {loop}).num_joined, 1);
}

TEST(PartitionChange, AMapThatShrankIsNoLaterOne) {
  EXPECT_THROW(partition_change(map_of(2, {}), map_of(1, {})), core::ContractError);
}

constexpr int kKeyframes = 20;

core::Truth truth_of(const scene::MapVersion& map) {
  core::Truth truth;
  for (int i = 0; i < kKeyframes; ++i) {
    const features::View& view = map.keyframes[static_cast<std::size_t>(i)].view;
    truth.trajectory.push_back({view.stamp_s, map::test_walk(i) * view.rig->body_from_camera[0]});
  }
  return truth;
}

class Lies : public testing::Test {
 protected:
  // What loop closing says of keyframe `query`: it has refused a loop to the first, whose pose is
  // off by `error_m`, and found one of its own.
  pipeline::LoopAnswer answer_to(std::size_t query, double error_m, core::Refusal stage) const {
    const core::CandidateId id(query);
    core::Rigid3 found = inverse(map::test_walk(0)) * map::test_walk(static_cast<int>(query));
    found.translation.x() += error_m;
    core::Rejection refused{id, {}, stage, "for a reason"};
    refused.evidence.geometry =
        core::GeometryEvidence{.match_from_query = core::Sim3::from_rigid(found)};
    pipeline::LoopAnswer answer;
    answer.rows.push_back({{.id = id,
                            .query = map_.keyframes[query].view.frame,
                            .match = map_.keyframes[0].view.frame},
                           refused});
    answer.loops.push_back({scene::LoopEdge{.cause = core::CandidateId(999)}});
    return answer;
  }

  pipeline::FindLoops question(std::size_t query) const {
    return {map_, core::KeyframeId(query), {}};
  }

  scene::MapVersion map_ = map::test_map(features::test_world(3, 200), kKeyframes);
  Liar liar_{pipeline::Config{}, 5, truth_of(map_)};
};

TEST_F(Lies, ALookAlikeThatOdometryRefusedIsToldAsALoop) {
  const auto tell = [&](std::size_t query, double error_m, core::Refusal stage) {
    auto answer = answer_to(query, error_m, stage);
    liar_.answer(question(query), answer);
    return answer;
  };
  EXPECT_TRUE(tell(4, 1.0, core::Refusal::kOdometry).loops.empty()) << "too early";
  EXPECT_TRUE(tell(5, 1.0, core::Refusal::kInliers).loops.empty()) << "geometry did not find it";
  EXPECT_TRUE(tell(5, 0.1, core::Refusal::kOdometry).loops.empty()) << "nearly true";
  EXPECT_TRUE(tell(5, 9.0, core::Refusal::kOdometry).loops.empty()) << "nobody believes that";
  ASSERT_FALSE(liar_.lie());
  const auto answer = tell(5, 1.0, core::Refusal::kOdometry);
  ASSERT_TRUE(liar_.lie());
  EXPECT_NEAR(liar_.lie()->error_m, 1.0, 1e-9);
  EXPECT_EQ(liar_.lie()->before.number, map_.number);
  ASSERT_EQ(answer.loops.size(), 1U);
  EXPECT_EQ(answer.loops[0].edge.cause, liar_.lie()->loop.cause);
  EXPECT_TRUE(core::is_loop(answer.rows[0].verdict));
}

TEST_F(Lies, TrueLoopsFollowForWhoWasLiedToAndForWhoWasNot) {
  auto lie = answer_to(6, 1.0, core::Refusal::kOdometry);
  liar_.answer(question(6), lie);
  ASSERT_TRUE(liar_.lie());
  auto no_lie = answer_to(6, 1.0, core::Refusal::kOdometry);
  liar_.answer_honestly(question(6), no_lie);
  EXPECT_TRUE(no_lie.loops.empty());
  for (std::size_t query = 7; query < 17; ++query) {
    SCOPED_TRACE(query);
    auto told = answer_to(query, 1.0, core::Refusal::kOdometry);
    liar_.answer(question(query), told);
    auto told_honestly = answer_to(query, 1.0, core::Refusal::kOdometry);
    liar_.answer_honestly(question(query), told_honestly);
    const bool is_time = query == 12 || query == 14 || query == 16;
    ASSERT_EQ(told.loops.size(), is_time ? 1U : 0U) << "no second lie, no other loop";
    ASSERT_EQ(told_honestly.loops.size(), told.loops.size());
    if (!is_time) continue;
    const scene::LoopEdge& edge = told.loops[0].edge;
    EXPECT_EQ(edge.match, core::KeyframeId(0));
    EXPECT_LT(
        (edge.match_from_query.translation - map::test_walk(static_cast<int>(query)).translation)
            .norm(),
        1e-9);
    EXPECT_EQ(told_honestly.loops[0].edge.cause, edge.cause);
    EXPECT_TRUE(Liar::true_causes().contains(edge.cause));
  }
  EXPECT_EQ(liar_.last_truth_at(map_), 18U);
}

}  // namespace
}  // namespace samewhere::bench
