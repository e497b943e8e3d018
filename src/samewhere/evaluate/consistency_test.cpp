#include <cmath>

#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/evaluate/consistency.hpp>

namespace samewhere::evaluate {
namespace {

constexpr double kSigma_m = 0.02;
constexpr double kSigma_rad = 0.01;

core::Trajectory walk(core::Random& random, int num_poses) {
  core::Trajectory truth;
  core::Rigid3 pose;
  for (int i = 0; i < num_poses; ++i) {
    truth.push_back({i / 10.0, pose});
    core::Vector6d step;
    for (double& value : step) value = 0.2 * random.gaussian();
    pose = pose * core::exp_r3so3(step);
  }
  return truth;
}

// Measured motions whose errors are `factor` times the standard deviation of their covariance.
std::vector<MeasuredMotion> measured(const core::Trajectory& truth, double factor,
                                     core::Random& random) {
  core::Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(kSigma_m), Eigen::Vector3d::Constant(kSigma_rad);
  std::vector<MeasuredMotion> motions;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const core::Rigid3 motion =
        inverse(truth[i - 1].world_from_camera) * truth[i].world_from_camera;
    core::Vector6d error;
    for (int k = 0; k < 6; ++k) error(k) = factor * sigma(k) * random.gaussian();
    motions.push_back(
        {truth[i - 1].stamp_s,
         truth[i].stamp_s,
         {{motion.rotation * core::exp_so3(error.tail<3>()), motion.translation + error.head<3>()},
          sigma.cwiseAbs2().asDiagonal()}});
  }
  return motions;
}

TEST(Consistency, AConsistentOneLiesInTheBandMostOfTheTime) {
  int num_inside = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    core::Random random(seed);
    const core::Trajectory truth = walk(random, 200);
    const auto found = consistency(measured(truth, 1.0, random), truth);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->num_motions, 199);
    EXPECT_NEAR(found->median, 5.35, 1.0);
    if (found->mean > found->band_low && found->mean < found->band_high) ++num_inside;
  }
  EXPECT_GE(num_inside, 88);
}

TEST(Consistency, TwiceTheStandardDeviationGivesFourTimesTheMean) {
  core::Random random(7);
  const core::Trajectory truth = walk(random, 2000);
  const auto found = consistency(measured(truth, 2.0, random), truth);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->mean, 24.0, 2.0);
  EXPECT_GT(found->mean, found->band_high);
  EXPECT_GT(found->outliers, 0.4);
  const auto conservative = consistency(measured(truth, 0.5, random), truth);
  EXPECT_LT(conservative->mean, conservative->band_low);
  EXPECT_EQ(conservative->outliers, 0.0);
}

TEST(Consistency, MotionsWithoutTruthDoNotCount) {
  core::Random random(8);
  core::Trajectory truth = walk(random, 30);
  auto motions = measured(truth, 1.0, random);
  truth.resize(20);
  EXPECT_EQ(consistency(motions, truth)->num_motions, 19);
  motions.resize(1);
  EXPECT_FALSE(consistency(motions, truth));
  EXPECT_FALSE(consistency(motions, {}));
}

}  // namespace
}  // namespace samewhere::evaluate
