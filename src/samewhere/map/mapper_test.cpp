#include <gtest/gtest.h>

#include <samewhere/features/test_world.hpp>
#include <samewhere/map/mapper.hpp>

namespace samewhere::map {
namespace {

class TestMapper : public testing::Test {
 protected:
  TestMapper() { map_ = apply(scene::MapVersion{}, start_map(map_, first_, core::Rigid3{})); }

  // The view from `reference_from_frame`, every feature of which shows the landmark of the same
  // point if the first view has it.
  TrackedView tracked_at(const core::Rigid3& reference_from_frame) const {
    TrackedView tracked{features::test_view(world_, 1, reference_from_frame), {}, {}};
    tracked.pose.reference_keyframe = core::KeyframeId(0);
    tracked.pose.reference_from_frame = reference_from_frame;
    for (const auto& match : features::match_pair(first_.features->descriptors,
                                                  tracked.view.features->descriptors, {})) {
      tracked.landmarks.emplace_back(
          match.second, map_.keyframes[0].slots[static_cast<std::size_t>(match.first)]);
    }
    return tracked;
  }

  features::TestWorld world_ = features::test_world(3);
  features::View first_ = features::test_view(world_, 0, {});
  scene::MapVersion map_;
  Config config_;
};

TEST_F(TestMapper, TheFirstKeyframeMakesALandmarkOfEveryFeatureWithDepth) {
  EXPECT_EQ(map_.keyframes.size(), 1U);
  EXPECT_EQ(static_cast<int>(map_.landmarks.size()), first_.features->size());
  EXPECT_FALSE(map_.keyframes[0].odometry);
  for (std::size_t i = 0; i < 20; ++i) {
    const scene::Landmark& landmark = map_.landmarks[i];
    EXPECT_LT((position_in_world(map_, landmark) -
               *features::point_in_camera(first_, static_cast<int>(i)))
                  .norm(),
              1e-9);
    EXPECT_NEAR(landmark.normal_in_anchor.norm(), 1.0, 1e-9);
  }
}

TEST_F(TestMapper, StandingStillAddsNoKeyframe) {
  EXPECT_FALSE(is_worth_keeping(map_, tracked_at({}), config_));
}

TEST_F(TestMapper, MovingTurningAndLosingSightEachAddOne) {
  EXPECT_TRUE(
      is_worth_keeping(map_, tracked_at({Eigen::Quaterniond::Identity(), {0.8, 0, 0}}), config_));
  EXPECT_TRUE(
      is_worth_keeping(map_, tracked_at({core::exp_so3({0.0, 0.3, 0.0}), {0, 0, 0}}), config_));
  TrackedView blind = tracked_at({});
  blind.landmarks.resize(blind.landmarks.size() / 3);
  EXPECT_TRUE(is_worth_keeping(map_, blind, config_));
}

TEST_F(TestMapper, AViewWithoutDepthIsNeverAKeyframe) {
  TrackedView blind{features::test_view(world_, 1, {}, 0.3, false), {}, {}};
  blind.pose.reference_keyframe = core::KeyframeId(0);
  EXPECT_FALSE(is_worth_keeping(map_, blind, config_));
  EXPECT_FALSE(can_start(blind.view, config_));
}

TEST_F(TestMapper, ASecondKeyframeSeesOldLandmarksAgainAndAddsNewOnes) {
  const core::Rigid3 moved{core::exp_so3({0.0, 0.4, 0.0}), {0.3, 0.0, 0.1}};
  const TrackedView tracked = tracked_at(moved);
  const scene::MapVersion grown = apply(map_, add_keyframe(map_, tracked));
  ASSERT_EQ(grown.keyframes.size(), 2U);
  const scene::Keyframe& second = grown.keyframes[1];
  ASSERT_TRUE(second.odometry);
  EXPECT_EQ(second.odometry->parent, core::KeyframeId(0));
  EXPECT_LT(core::log_r3so3(inverse(moved) * second.world_from_body).norm(), 1e-9);
  EXPECT_EQ(grown.landmarks.size(),
            map_.landmarks.size() + second.slots.size() - tracked.landmarks.size());
  const auto [feature, landmark] = tracked.landmarks.front();
  EXPECT_EQ(second.slots[static_cast<std::size_t>(feature)], landmark);
  EXPECT_EQ(grown.at(landmark).observations.size(), 2U);
  EXPECT_EQ(grown.at(second.slots.back()).observations.back().keyframe, second.id);
}

}  // namespace
}  // namespace samewhere::map
