#include <cstdint>

#include <gtest/gtest.h>

#include <samewhere/correct/deformation.hpp>

namespace samewhere::correct {
namespace {

// One lap of a square of 40 m, with a small rotation error at each step.
scene::MapVersion lap() {
  scene::Edit edit;
  core::Rigid3 estimate;
  for (int i = 0; i <= 40; ++i) {
    scene::Keyframe keyframe;
    keyframe.id = core::KeyframeId(static_cast<std::uint64_t>(i));
    if (i > 0) {
      const core::Rigid3 step{core::exp_so3({0.0, (i % 10 == 0 ? 1.5707963 : 0.0) + 0.001, 0.0}),
                              {0.0, 0.0, 1.0}};
      estimate = estimate * step;
      keyframe.odometry = {core::KeyframeId(static_cast<std::uint64_t>(i - 1)), step,
                           1e4 * core::Matrix6d::Identity()};
    }
    keyframe.world_from_body = estimate;
    edit.keyframes.push_back(keyframe);
  }
  return apply(scene::MapVersion{}, edit);
}

scene::LoopEdge loop(std::uint64_t query, std::uint64_t match, const core::Rigid3& pose) {
  scene::LoopEdge edge;
  edge.query = core::KeyframeId(query);
  edge.match = core::KeyframeId(match);
  edge.match_from_query = pose;
  edge.information = 1e4 * core::Matrix6d::Identity();
  edge.cause = core::CandidateId(0);
  return edge;
}

TEST(Deformation, ATrueLoopBendsTheTrajectoryLittleAndAFalseOneMuch) {
  const scene::MapVersion map = lap();
  const auto of_true = measure_deformation(map, loop(40, 0, core::Rigid3{}), {});
  const auto of_false = measure_deformation(map, loop(39, 10, core::Rigid3{}), {});
  ASSERT_TRUE(of_true && of_false);
  EXPECT_NEAR(of_true->path_m, 40.0, 0.01);
  EXPECT_LT(of_true->rmse_m, 0.01 * of_true->path_m);
  EXPECT_GT(of_false->rmse_m, 0.05 * of_false->path_m);
}

TEST(Deformation, ALoopThatAgreesWithOdometryBendsNothing) {
  const scene::MapVersion map = lap();
  const core::Rigid3 known =
      inverse(map.keyframes[5].world_from_body) * map.keyframes[35].world_from_body;
  const auto found = measure_deformation(map, loop(35, 5, known), {});
  ASSERT_TRUE(found);
  EXPECT_LT(found->rmse_m, 1e-6);
}

TEST(Deformation, BetweenNeighboursNothingCanBend) {
  EXPECT_FALSE(measure_deformation(lap(), loop(6, 5, core::Rigid3{}), {}));
}

}  // namespace
}  // namespace samewhere::correct
