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
  loop.evidence.odometry = core::OdometryEvidence{.sigma_m = 0.1, .look_alike_gain = 900.0};
  return {{.id = id, .query = core::FrameId(12), .match = core::FrameId(0)}, loop};
}

TEST_F(LookAlikeRooms, AWrongLoopMakesThemOneAndWithoutItTheyAreTwo) {
  EXPECT_EQ(num_seen_in_both_rooms(map_), 0);
  const MapVersion with_false = closed(map_, false_loop());
  ASSERT_EQ(with_false.loops.size(), 1U);
  ASSERT_GT(num_seen_in_both_rooms(with_false), 100)
      << "without fused landmarks this shows nothing";
  EXPECT_GT(rmse_m(with_false), 2.0);
  EXPECT_EQ(correct::pose_graph_of(with_false, config_.optimize).edges.size(),
            num_live(with_false.keyframes))
      << "a parent of each but the first, and the loop: shared landmarks are no edges";
  const MapVersion after = without_loop(with_false, kFalseLoop, config_);
  EXPECT_EQ(survivors(after), survivors(map_));
  EXPECT_EQ(num_seen_in_both_rooms(after), 0);
  EXPECT_LT(rmse_m(after), 1.02 * rmse_m(map_) + 1e-3);
}

TEST_F(LookAlikeRooms, TrueLoopsThatComeLaterPartThemAgain) {
  for (odometry_seed_ = 1; odometry_seed_ <= 8; ++odometry_seed_) {
    SCOPED_TRACE("seed " + std::to_string(odometry_seed_));
    walk_both();
    MapVersion with_false = closed(map_, false_loop());
    MapVersion never = map_;
    for (int i = 0; i < 3; ++i) {  // tracking follows the wrong room's landmarks, mapping merges on
      with_false = with_next(with_false);
      never = with_next(never);
    }
    ASSERT_GT(num_seen_in_both_rooms(with_false), 100);
    for (const std::size_t query : {13U, 14U}) {
      with_false = closed(with_false, true_loop(query, 14 - query));
      never = closed(never, true_loop(query, 14 - query));
    }
    ASSERT_EQ(never.loops.size(), 2U);
    EXPECT_EQ(with_false.loops.size(), 2U);
    ASSERT_EQ(with_false.suspended_loops.size(), 1U);
    EXPECT_EQ(with_false.suspended_loops[0].cause, kFalseLoop);
    EXPECT_EQ(survivors(with_false), survivors(map_));
    EXPECT_EQ(num_seen_in_both_rooms(with_false), 0);
    EXPECT_LT(rmse_m(with_false), 1.02 * rmse_m(never)) << "the goal of the bench undo";
  }
}

TEST_F(LookAlikeRooms, OneTrueLoopThatOverrulesTwoFalseOnesPartsThem) {
  MapVersion with_false = closed(map_, false_loop());
  with_false = closed(with_false, loop(2 * kPerRoom - 2, kPerRoom - 2, {}, core::CandidateId(8)));
  ASSERT_EQ(with_false.loops.size(), 2U);
  with_false = with_next(with_false);
  const auto spoken = correct::between_holders(with_false, true_loop(12, 1)).value();
  EXPECT_TRUE(with_loop(with_false, spoken, config_).closing.rejected) << "one against two";

  const Correction correction = with_loop(with_false, spoken, config_, kFalseLoop);
  EXPECT_EQ(correction.closing.withdrawn.size(), 2U);
  ASSERT_EQ(correction.map.loops.size(), 1U);
  EXPECT_TRUE(correction.map.suspended_loops.empty());
  EXPECT_EQ(survivors(correction.map), survivors(map_));
  EXPECT_EQ(num_seen_in_both_rooms(correction.map), 0);
  EXPECT_LT(rmse_m(correction.map), 0.1);

  // a third false loop, accepted while the other two were
  const core::LedgerRow row = accepted(core::CandidateId(9));
  const scene::LoopEdge third = loop(
      2 * kPerRoom, kPerRoom - 1, inverse(map::test_walk(5)) * map::test_walk(6), row.candidate.id);
  verify::OdometryTree odometry;
  EXPECT_TRUE(core::is_loop(reverify(with_false, odometry, third, row, config_)));
  EXPECT_EQ(core::stage_of(reverify(correction.map, odometry, third, row, config_)), "competing");
}

// Keyframes culled while the false loop was accepted had their parent in the other room.
TEST_F(LookAlikeRooms, TheyArePartedThoughKeyframesWentMeanwhile) {
  config_.map.redundant_ratio = Config{}.map.redundant_ratio;
  walk_both();
  MapVersion with_false = closed(map_, false_loop());
  const std::size_t num_before = num_live(with_false.keyframes);
  for (int i = 0; i < 3; ++i) with_false = with_next(with_false);
  ASSERT_LT(num_live(with_false.keyframes), num_before + 3) << "one went at least";
  for (const std::size_t query : {13U, 14U})
    with_false = closed(with_false, true_loop(query, 14 - query));
  EXPECT_EQ(with_false.loops.size(), 2U);
  ASSERT_EQ(with_false.suspended_loops.size(), 1U);
  EXPECT_EQ(with_false.suspended_loops[0].cause, kFalseLoop);
  EXPECT_EQ(num_seen_in_both_rooms(with_false), 0);
  EXPECT_LT(rmse_m(with_false), 0.1);
}

}  // namespace
}  // namespace samewhere::pipeline
