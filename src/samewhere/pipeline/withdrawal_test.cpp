#include <string>

#include <gtest/gtest.h>

#include <samewhere/correct/loop_corrector.hpp>
#include <samewhere/pipeline/loop_closing.hpp>
#include <samewhere/pipeline/test_rooms.hpp>
#include <samewhere/pipeline/withdrawal.hpp>

namespace samewhere::pipeline {
namespace {

using scene::MapVersion;

core::LedgerRow accepted(core::CandidateId id) {
  core::LoopClosure loop{.candidate = id};
  loop.evidence.geometry = core::GeometryEvidence{.num_matches = 200,
                                                  .num_inliers = 150,
                                                  .inlier_ratio = 0.75,
                                                  .spread_ratio = 0.5,
                                                  .match_from_query = core::Sim3{}};
  return {{.id = id, .query = core::FrameId(12), .match = core::FrameId(0)}, loop};
}

TEST_F(LookAlikeRooms, AWrongLoopMakesThemOneAndWithoutItTheyAreTwo) {
  EXPECT_EQ(num_seen_in_both_rooms(map_), 0);
  const MapVersion believed = closed(map_, lie());
  ASSERT_EQ(believed.loops.size(), 1U);
  ASSERT_GT(num_seen_in_both_rooms(believed), 100) << "without fused landmarks this shows nothing";
  EXPECT_GT(rmse_m(believed), 2.0);
  EXPECT_EQ(correct::pose_graph_of(believed, config_.optimize).edges.size(),
            num_live(believed.keyframes))
      << "a parent of each but the first, and the loop: who shares landmarks has no edge";
  const MapVersion after = without_loop(believed, kLie, config_);
  EXPECT_EQ(survivors(after), survivors(map_));
  EXPECT_EQ(num_seen_in_both_rooms(after), 0);
  EXPECT_LT(rmse_m(after), 1.02 * rmse_m(map_) + 1e-3);
}

TEST_F(LookAlikeRooms, TrueLoopsThatComeLaterPartThemAgain) {
  for (odometry_seed_ = 1; odometry_seed_ <= 8; ++odometry_seed_) {
    SCOPED_TRACE("seed " + std::to_string(odometry_seed_));
    walk_both();
    MapVersion believed = closed(map_, lie());
    MapVersion never = map_;
    for (int i = 0; i < 3; ++i) {  // tracking follows the wrong room's landmarks, mapping merges on
      believed = with_next(believed);
      never = with_next(never);
    }
    ASSERT_GT(num_seen_in_both_rooms(believed), 100);
    for (const std::size_t query : {13U, 14U}) {
      believed = closed(believed, true_loop(query, 14 - query));
      never = closed(never, true_loop(query, 14 - query));
    }
    ASSERT_EQ(never.loops.size(), 2U);
    EXPECT_EQ(believed.loops.size(), 2U);
    ASSERT_EQ(believed.suspended_loops.size(), 1U);
    EXPECT_EQ(believed.suspended_loops[0].cause, kLie);
    EXPECT_EQ(survivors(believed), survivors(map_));
    EXPECT_EQ(num_seen_in_both_rooms(believed), 0);
    EXPECT_LT(rmse_m(believed), 1.02 * rmse_m(never)) << "the goal of the bench undo";
  }
}

TEST_F(LookAlikeRooms, OneTrueLoopThatOverrulesTwoLiesPartsThem) {
  MapVersion believed = closed(map_, lie());
  believed = closed(believed, loop(2 * kPerRoom - 2, kPerRoom - 2, {}, core::CandidateId(8)));
  ASSERT_EQ(believed.loops.size(), 2U);
  believed = with_next(believed);
  const auto spoken = correct::between_holders(believed, true_loop(12, 1)).value();
  EXPECT_TRUE(with_loop(believed, spoken, config_).closing.rejected) << "one against two";

  const Correction correction = with_loop(believed, spoken, config_, kLie);
  EXPECT_EQ(correction.closing.withdrawn.size(), 2U);
  ASSERT_EQ(correction.map.loops.size(), 1U);
  EXPECT_TRUE(correction.map.suspended_loops.empty());
  EXPECT_EQ(survivors(correction.map), survivors(map_));
  EXPECT_EQ(num_seen_in_both_rooms(correction.map), 0);
  EXPECT_LT(rmse_m(correction.map), 0.1);

  // a third lie, accepted while the other two were believed
  const core::LedgerRow row = accepted(core::CandidateId(9));
  const scene::LoopEdge third = loop(
      2 * kPerRoom, kPerRoom - 1, inverse(map::test_walk(5)) * map::test_walk(6), row.candidate.id);
  EXPECT_TRUE(core::is_loop(reverify(believed, third, row, config_)));
  EXPECT_EQ(core::stage_of(reverify(correction.map, third, row, config_)), "competing");
}

// What was culled while the lie was believed hung on the other room.
TEST_F(LookAlikeRooms, TheyArePartedThoughKeyframesWentMeanwhile) {
  config_.map.redundant_ratio = Config{}.map.redundant_ratio;
  walk_both();
  MapVersion believed = closed(map_, lie());
  const std::size_t num_before = num_live(believed.keyframes);
  for (int i = 0; i < 3; ++i) believed = with_next(believed);
  ASSERT_LT(num_live(believed.keyframes), num_before + 3) << "one went at least";
  for (const std::size_t query : {13U, 14U})
    believed = closed(believed, true_loop(query, 14 - query));
  EXPECT_EQ(believed.loops.size(), 2U);
  ASSERT_EQ(believed.suspended_loops.size(), 1U);
  EXPECT_EQ(believed.suspended_loops[0].cause, kLie);
  EXPECT_EQ(num_seen_in_both_rooms(believed), 0);
  EXPECT_LT(rmse_m(believed), 0.1);
}

}  // namespace
}  // namespace samewhere::pipeline
