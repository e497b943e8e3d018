#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>

namespace samewhere::evaluate {
namespace {

core::StampedPose standing_at(double stamp_s, double x, double y, double z) {
  return {stamp_s, {Eigen::Quaterniond::Identity(), {x, y, z}}};
}

// A walk through space that turns on the way, 20 poses a second.
core::Trajectory random_walk(core::Random& random, int num_poses) {
  core::Trajectory trajectory;
  core::Rigid3 pose;
  for (int i = 0; i < num_poses; ++i) {
    core::Vector6d step;
    for (double& value : step) value = 0.05 * random.gaussian();
    pose = pose * core::exp_r3so3(step);
    trajectory.push_back({i / 20.0, pose});
  }
  return trajectory;
}

core::Trajectory seen_from(const core::Sim3& other_from_world, const core::Trajectory& trajectory) {
  core::Trajectory result;
  for (const core::StampedPose& pose : trajectory) {
    const core::Rigid3& world_from_camera = pose.world_from_camera;
    result.push_back({pose.stamp_s,
                      {other_from_world.rotation * world_from_camera.rotation,
                       other_from_world * world_from_camera.translation}});
  }
  return result;
}

TEST(TruthAt, LiesBetweenItsNeighbours) {
  core::Trajectory truth{standing_at(0.0, 0, 0, 0), standing_at(0.1, 1, 2, 3)};
  truth[1].world_from_camera.rotation = core::exp_so3({0, 0, 1.0});
  const std::optional<core::Rigid3> pose = truth_at(truth, 0.025);
  ASSERT_TRUE(pose);
  EXPECT_LT((pose->translation - Eigen::Vector3d(0.25, 0.5, 0.75)).norm(), 1e-12);
  EXPECT_NEAR(core::angle_rad(pose->rotation), 0.25, 1e-12);
}

TEST(TruthAt, IsUnknownInAGapUnlessOnAStamp) {
  const core::Trajectory truth{standing_at(0.0, 0, 0, 0), standing_at(0.2, 1, 0, 0),
                               standing_at(0.25, 2, 0, 0)};
  EXPECT_FALSE(truth_at(truth, 0.1));
  EXPECT_FALSE(truth_at(truth, 0.0011));
  EXPECT_TRUE(truth_at(truth, 0.0009));
  EXPECT_TRUE(truth_at(truth, 0.1995));
  EXPECT_TRUE(truth_at(truth, 0.22));
}

TEST(TruthAt, EndsWithTheTruth) {
  const core::Trajectory truth{standing_at(1.0, 0, 0, 0), standing_at(1.05, 1, 0, 0)};
  EXPECT_FALSE(truth_at(truth, 0.9));
  EXPECT_FALSE(truth_at(truth, 1.06));
  ASSERT_TRUE(truth_at(truth, 0.9995));
  EXPECT_EQ(truth_at(truth, 0.9995)->translation.x(), 0.0);
  EXPECT_EQ(truth_at(truth, 1.0505)->translation.x(), 1.0);
  EXPECT_FALSE(truth_at({}, 1.0));
  EXPECT_FALSE(truth_at({standing_at(1.0, 0, 0, 0)}, 1.0));
}

TEST(Ate, OfASquareWithOneCornerPulledOutIsKnown) {
  // by symmetry the best alignment of four corners lifted by +h -h +h -h is none at all
  const double h = 0.1;
  const core::Trajectory truth{standing_at(0.0, 0, 0, 0), standing_at(0.1, 1, 0, 0),
                               standing_at(0.2, 1, 1, 0), standing_at(0.3, 0, 1, 0)};
  const core::Trajectory estimate{standing_at(0.0, 0, 0, h), standing_at(0.1, 1, 0, -h),
                                  standing_at(0.2, 1, 1, h), standing_at(0.3, 0, 1, -h)};
  const std::optional<AteResult> result = ate(truth, estimate, Alignment::kSe3);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->num_poses, 4);
  EXPECT_NEAR(result->rmse_m, h, 1e-12);
  EXPECT_NEAR(result->median_m, h, 1e-12);
  EXPECT_NEAR(result->max_m, h, 1e-12);
  EXPECT_NEAR(result->min_m, h, 1e-12);
}

TEST(Ate, OfThePointsOfALineIsWhatIsLeftAfterTheMean) {
  const core::Trajectory truth{standing_at(0.0, 0, 0, 0), standing_at(0.1, 0, 0, 0),
                               standing_at(0.2, 0, 0, 0), standing_at(0.3, 0, 0, 0)};
  const core::Trajectory estimate{standing_at(0.0, 0, 0, 0), standing_at(0.1, 0, 0, 0),
                                  standing_at(0.2, 0, 0, 0), standing_at(0.3, 4, 0, 0)};
  const std::optional<AteResult> result = ate(truth, estimate, Alignment::kSe3);
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->max_m, 3.0, 1e-12);
  EXPECT_NEAR(result->min_m, 1.0, 1e-12);
  EXPECT_NEAR(result->median_m, 1.0, 1e-12);
  EXPECT_NEAR(result->rmse_m, std::sqrt(3.0), 1e-12);
}

TEST(Ate, DoesNotDependOnTheWorldOfTheEstimate) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    core::Random random(seed);
    const core::Trajectory truth = random_walk(random, 100);
    const core::Sim3 other_from_world{
        random.uniform(0.2, 4.0),
        core::exp_so3({random.gaussian(), random.gaussian(), random.gaussian()}),
        {random.gaussian(), random.gaussian(), random.gaussian()}};
    const std::optional<AteResult> result =
        ate(truth, seen_from(other_from_world, truth), Alignment::kSim3);
    ASSERT_TRUE(result);
    EXPECT_LT(result->max_m, 1e-9);
    EXPECT_NEAR(result->scale * other_from_world.scale, 1.0, 1e-9);
    const core::Trajectory back =
        seen_from(result->truth_from_estimate, seen_from(other_from_world, truth));
    EXPECT_LT(
        (core::inverse(back[7].world_from_camera) * truth[7].world_from_camera).translation.norm(),
        1e-9);
  }
}

TEST(Ate, WithRigidAlignmentAWrongScaleIsAnError) {
  core::Random random(3);
  const core::Trajectory truth = random_walk(random, 100);
  const core::Sim3 twice{2.0, Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero()};
  EXPECT_GT(ate(truth, seen_from(twice, truth), Alignment::kSe3)->rmse_m, 0.05);
}

TEST(Ate, NeedsThreePosesWithATruth) {
  const core::Trajectory truth{standing_at(0.0, 0, 0, 0), standing_at(0.1, 1, 0, 0),
                               standing_at(0.2, 1, 1, 0)};
  const core::Trajectory two(truth.begin(), truth.begin() + 2);
  core::Trajectory late = truth;
  for (core::StampedPose& pose : late) pose.stamp_s += 10.0;
  EXPECT_TRUE(ate(truth, truth, Alignment::kSe3));
  EXPECT_FALSE(ate(truth, two, Alignment::kSe3));
  EXPECT_FALSE(ate(truth, late, Alignment::kSe3));
  EXPECT_FALSE(ate(truth, {}, Alignment::kSe3));
  EXPECT_FALSE(ate({}, truth, Alignment::kSe3));
}

TEST(Rpe, OfASteadyDriftIsTheDriftOfOneSecond) {
  const double drift_m_s = 0.02;
  const double drift_rad_s = 0.03;
  core::Trajectory truth;
  core::Trajectory estimate;
  for (int i = 0; i <= 100; ++i) {
    const double stamp_s = i / 20.0;
    truth.push_back(standing_at(stamp_s, 0, 0, 0));
    estimate.push_back(standing_at(stamp_s, 0, drift_m_s * stamp_s, 0));
    estimate.back().world_from_camera.rotation = core::exp_so3({0, drift_rad_s * stamp_s, 0});
  }
  const std::optional<RpeResult> result = rpe(truth, estimate);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->num_pairs, 81 + 2);  // the last two seconds hold pairs 0.9 and 0.95 s long too
  EXPECT_NEAR(result->translation_median_m, drift_m_s, 1e-9);
  EXPECT_NEAR(result->rotation_median_deg, drift_rad_s * 180.0 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(result->translation_rmse_m, drift_m_s, 1e-4);
  EXPECT_NEAR(result->rotation_rmse_deg, drift_rad_s * 180.0 / std::numbers::pi, 1e-2);
}

TEST(Rpe, DoesNotDependOnTheWorldOfTheEstimateOnceTheScaleIsKnown) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    core::Random random(seed);
    const core::Trajectory truth = random_walk(random, 60);
    const core::Sim3 other_from_world{2.0, core::exp_so3({random.gaussian(), 1.0, 0.3}), {1, 2, 3}};
    const core::Trajectory estimate = seen_from(other_from_world, truth);
    EXPECT_LT(rpe(truth, estimate, 1.0, 0.5)->translation_rmse_m, 1e-9);
    EXPECT_LT(rpe(truth, estimate, 1.0, 0.5)->rotation_rmse_deg, 1e-5);
    EXPECT_GT(rpe(truth, estimate, 1.0, 1.0)->translation_rmse_m, 1e-3);
  }
}

TEST(Rpe, HasNoAnswerWithoutAPairThatFarApart) {
  const core::Trajectory sparse{standing_at(0.0, 0, 0, 0), standing_at(0.5, 0, 0, 0),
                                standing_at(1.5, 0, 0, 0)};
  EXPECT_EQ(rpe(sparse, sparse, 1.0)->num_pairs, 1);
  EXPECT_FALSE(rpe(sparse, sparse, 0.7));
  EXPECT_FALSE(rpe(sparse, {}, 1.0));
  EXPECT_FALSE(rpe({}, sparse, 1.0));
  EXPECT_THROW(rpe(sparse, sparse, 0.0), core::ContractError);
}

TEST(PathLength, CountsEveryStepBetweenTheStampsAndNoOther) {
  const core::Trajectory there_and_back = {
      standing_at(0.0, 0.0, 0.0, 0.0), standing_at(1.0, 3.0, 4.0, 0.0),
      standing_at(2.0, 0.0, 0.0, 0.0), standing_at(3.0, 0.0, 0.0, 7.0)};
  EXPECT_DOUBLE_EQ(path_length_m(there_and_back, 0.0, 3.0), 17.0);
  EXPECT_DOUBLE_EQ(path_length_m(there_and_back, 0.0, 2.0), 10.0);
  EXPECT_DOUBLE_EQ(path_length_m(there_and_back, 0.5, 9.0), 12.0);
  EXPECT_DOUBLE_EQ(path_length_m({}, 0.0, 1.0), 0.0);
}

}  // namespace
}  // namespace samewhere::evaluate
