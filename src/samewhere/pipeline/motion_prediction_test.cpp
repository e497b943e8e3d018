#include <gtest/gtest.h>

#include <samewhere/features/test_world.hpp>
#include <samewhere/map/test_map.hpp>
#include <samewhere/pipeline/motion_prediction.hpp>

namespace samewhere::pipeline {
namespace {

// A camera that moves along x at 1 m/s, in a map of 10 m.
class MotionPredictionTest : public testing::Test {
 protected:
  MotionPredictionTest() {
    const features::TestWorld world = features::test_world(3);
    map_ = apply(map_, map::start_map(map_, features::test_view(world, 0, {}), {}));
    map_ = apply(map_, map::start_map(map_, features::test_view(world, 1, {}), at(10.0)));
  }

  static core::Rigid3 at(double x_m) { return {Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}}; }

  static core::FramePose pose_at(double x_m, double stamp_s) {
    core::FramePose pose;
    pose.stamp_s = stamp_s;
    pose.is_measured = true;
    pose.reference_keyframe = core::KeyframeId(0);
    pose.reference_from_frame = at(x_m);
    return pose;
  }

  MotionPrediction after(double lost_s) const {
    return {map_, {&last_, &before_}, last_.stamp_s + lost_s, {}};
  }

  scene::MapVersion map_;
  core::FramePose before_ = pose_at(0.9, 0.9);
  core::FramePose last_ = pose_at(1.0, 1.0);
};

TEST_F(MotionPredictionTest, RepeatsTheLastMotion) {
  EXPECT_TRUE(after(0.2).allows(map_, pose_at(1.2, 1.2)));
  EXPECT_FALSE(after(0.2).allows(map_, pose_at(2.0, 1.2)));
  EXPECT_FALSE(after(0.2).allows(map_, pose_at(0.6, 1.2)));
}

TEST_F(MotionPredictionTest, ItsGateGrowsWithTheTimeLost) {
  EXPECT_FALSE(after(0.3).allows(map_, pose_at(3.0, 1.3)));
  EXPECT_TRUE(after(1.5).allows(map_, pose_at(3.5, 2.5)));
}

TEST_F(MotionPredictionTest, SaysLessTheLongerTheCameraIsLost) {
  const auto at_prediction = [&](double lost_s) {
    return after(lost_s).log_likelihood_ratio(map_, pose_at(1.0 + lost_s, 1.0 + lost_s));
  };
  EXPECT_GT(at_prediction(0.2), at_prediction(1.0));
  EXPECT_GT(at_prediction(1.0), at_prediction(3.0));
  EXPECT_LT(at_prediction(30.0), 0.1) << "the camera may be anywhere";
}

// The next door, or the landing of the next floor.
TEST_F(MotionPredictionTest, NeverConfirmsALookAlikeAtTheLeastDistance) {
  map_ = apply(
      map_, map::start_map(map_, features::test_view(features::test_world(3), 2, {}), at(100.0)));
  for (double lost_s = 0.1; lost_s < 20.0; lost_s += 0.1) {
    const core::FramePose lookalike = pose_at(1.0 + lost_s + 3.0, 1.0 + lost_s);
    EXPECT_LT(after(lost_s).log_likelihood_ratio(map_, lookalike), 0.5) << lost_s;
  }
}

TEST_F(MotionPredictionTest, ConfirmsACameraThatStoppedIfNoLookAlikeIsInReach) {
  EXPECT_GT(after(1.5).log_likelihood_ratio(map_, pose_at(1.0, 2.5)), 2.5);
  EXPECT_LT(after(2.1).log_likelihood_ratio(map_, pose_at(1.0, 3.1)), 2.5);
}

// One image a second, read as 30 a second: the camera moves 1 m from image to image.
TEST_F(MotionPredictionTest, WithStampsThatMakeTheCameraTooFastItSaysLess) {
  const core::FramePose before = pose_at(0.0, 1.0 - 1.0 / 30.0);
  const auto at_prediction = [&](int num_lost) {
    const double stamp_s = last_.stamp_s + num_lost / 30.0;
    const MotionPrediction prediction(map_, {&last_, &before}, stamp_s, {});
    return prediction.log_likelihood_ratio(map_, pose_at(1.0 + num_lost, stamp_s));
  };
  EXPECT_GT(at_prediction(1), 2.5);
  EXPECT_LT(at_prediction(5), 2.5);
}

TEST_F(MotionPredictionTest, SaysNothingOfASessionWithoutAPose) {
  const MotionPrediction unknown(map_, {}, 5.0, {});
  EXPECT_FALSE(unknown.allows(map_, pose_at(1.0, 5.0)));
  EXPECT_EQ(unknown.log_likelihood_ratio(map_, pose_at(1.0, 5.0)), 0.0);
}

TEST_F(MotionPredictionTest, WithoutAVelocityTheCameraMayHaveWalked) {
  const MotionPrediction prediction(map_, {&last_, nullptr}, 1.5, {});
  EXPECT_TRUE(prediction.allows(map_, pose_at(1.5, 1.5)));
  EXPECT_TRUE(prediction.allows(map_, pose_at(0.5, 1.5)));
  EXPECT_FALSE(prediction.allows(map_, pose_at(5.0, 1.5)));
}

}  // namespace
}  // namespace samewhere::pipeline
