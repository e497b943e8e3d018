#include <cmath>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/twin/building/angles.hpp>
#include <samewhere/twin/motion/inertial.hpp>

namespace samewhere::twin {
namespace {

Route tour(Carrier carrier) {
  const bool is_robot = carrier == Carrier::kRobot;
  return {.start_m = {0.0, 0.0, 0.0},
          .start_heading_rad = 0.0,
          .steps = {WalkTo{{5, 0, 0}}, WalkTo{{5, 4, 0}}, WalkTo{{9, 4, 1.5}}, WalkTo{{12, 4, 1.5}},
                    Stand{2.0}, TurnTo{kPi}, WalkTo{{9, 4, 1.5}}, WalkTo{{9, 8, 1.5}}},
          .carrier = carrier,
          .speed_m_s = is_robot ? 0.8 : 1.3,
          .camera_height_m = is_robot ? 0.6 : 1.5};
}

class InertialUnit : public testing::TestWithParam<Carrier> {
 protected:
  Motion motion_{tour(GetParam()), 3};
};

TEST_P(InertialUnit, CleanSamplesLeadToTheTrueMotion) {
  const InertialNoise none = InertialNoise::none();
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Motion motion(tour(GetParam()), seed);
    const auto samples = inertial_samples(motion, none, 1);
    for (std::size_t k = 0; k + 200 < samples.size(); k += 170) {
      SCOPED_TRACE(testing::Message()
                   << "seed " << seed << ", from " << samples[k].stamp_s << " s");
      const InertialState begin = true_state(motion, samples[k].stamp_s, {});
      const double until_s = samples[k + 200].stamp_s;
      const InertialState end = integrated(begin, samples, none, until_s);
      const core::Vector6d error = pose_error(end.world_from_body, motion.world_from_body(until_s));
      EXPECT_LT(error.head<3>().norm(), 1e-3);
      EXPECT_LT(error.tail<3>().norm(), 0.01 * kDegree_rad);
      EXPECT_EQ(end.pose_sigma().norm(), 0.0);
      EXPECT_NEAR(end.stamp_s, until_s, 1e-9);
    }
  }
}

// The state that errs by `error`, in the order of the covariance.
InertialState disturbed(const InertialState& state, const Eigen::Matrix<double, 15, 1>& error) {
  InertialState wrong = state;
  wrong.world_from_body.translation += error.segment<3>(0);
  wrong.world_from_body.rotation =
      state.world_from_body.rotation * core::exp_so3(error.segment<3>(3));
  wrong.velocity_m_s += error.segment<3>(6);
  wrong.bias.gyroscope_rad_s += error.segment<3>(9);
  wrong.bias.accelerometer_m_s2 += error.segment<3>(12);
  return wrong;
}

TEST_P(InertialUnit, TheCovarianceFollowsWhatAnErrorDoes) {
  constexpr double kScale = 1e-4;
  const InertialNoise none = InertialNoise::none();
  const auto samples = inertial_samples(motion_, none, 1);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    core::Random random(core::seed_of(seed, "test.error", 0));
    Eigen::Matrix<double, 15, 1> error;
    for (double& value : error) value = random.gaussian();
    InertialState begin = true_state(motion_, 4.0, {});
    begin.covariance = error * error.transpose();
    const InertialState end = integrated(begin, samples, none, 5.0);
    const InertialState wrong = integrated(disturbed(begin, kScale * error), samples, none, 5.0);
    const core::Vector6d moved = pose_error(wrong.world_from_body, end.world_from_body) / kScale;
    const core::Matrix6d expected = moved * moved.transpose();
    const core::Matrix6d covariance = end.covariance.topLeftCorner<6, 6>();
    EXPECT_LT((covariance - expected).norm(), 0.1 + 0.02 * expected.norm()) << "seed " << seed;
  }
}

// Squared error over its covariance, per degree of freedom, of one second.
double chi_square(const InertialState& end, const core::Rigid3& truth) {
  const core::Vector6d error = pose_error(end.world_from_body, truth);
  const core::Matrix6d covariance = end.covariance.topLeftCorner<6, 6>();
  return error.dot(covariance.ldlt().solve(error)) / 6.0;
}

TEST_P(InertialUnit, NoisySamplesLeadThereWithinTheirOwnSigma) {
  const InertialNoise noise;
  double sum = 0.0;
  int num_windows = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto samples = inertial_samples(motion_, noise, seed);
    const auto biases = inertial_biases(motion_, noise, seed);
    for (std::size_t k = 0; k + 200 < samples.size(); k += 200) {
      const double until_s = samples[k + 200].stamp_s;
      const InertialState end =
          integrated(true_state(motion_, samples[k].stamp_s, biases[k]), samples, noise, until_s);
      const core::Rigid3 truth = motion_.world_from_body(until_s);
      const core::Vector6d ratios =
          pose_error(end.world_from_body, truth).cwiseQuotient(end.pose_sigma());
      EXPECT_LT(ratios.cwiseAbs().maxCoeff(), 4.0) << "seed " << seed << ", to " << until_s << " s";
      sum += chi_square(end, truth);
      ++num_windows;
    }
  }
  EXPECT_GT(num_windows, 300);
  EXPECT_GT(sum / num_windows, 0.85);
  EXPECT_LT(sum / num_windows, 1.15);
}

TEST_P(InertialUnit, AnUnknownBiasIsCoveredByItsFirstUncertainty) {
  const InertialNoise noise;
  double sum = 0.0;
  constexpr int kNumSeeds = 100;
  for (std::uint64_t seed = 0; seed < kNumSeeds; ++seed) {
    const auto samples = inertial_samples(motion_, noise, seed);
    InertialState begin = true_state(motion_, 0.0, {});
    const double gyroscope = noise.gyroscope_first_bias_rad_s;
    const double accelerometer = noise.accelerometer_first_bias_m_s2;
    begin.covariance.diagonal().segment<3>(9).setConstant(gyroscope * gyroscope);
    begin.covariance.diagonal().segment<3>(12).setConstant(accelerometer * accelerometer);
    const InertialState end = integrated(begin, samples, noise, 3.0);
    sum += chi_square(end, motion_.world_from_body(3.0));
  }
  EXPECT_GT(sum / kNumSeeds, 0.8);
  EXPECT_LT(sum / kNumSeeds, 1.2);
}

TEST_P(InertialUnit, SamplesAreEvenAndTheSameForASeed) {
  const auto first = inertial_samples(motion_, {}, 5);
  const auto again = inertial_samples(motion_, {}, 5);
  const auto other = inertial_samples(motion_, {}, 6);
  ASSERT_EQ(first.size(), again.size());
  EXPECT_EQ(first.size(), inertial_biases(motion_, {}, 5).size());
  EXPECT_NEAR(first.back().stamp_s, motion_.duration_s(), 0.5 / kImuRate_hz);
  for (std::size_t k = 0; k < first.size(); ++k) {
    ASSERT_DOUBLE_EQ(first[k].stamp_s, static_cast<double>(k) / kImuRate_hz);
    ASSERT_EQ(first[k].angular_velocity_rad_s, again[k].angular_velocity_rad_s);
    ASSERT_EQ(first[k].acceleration_m_s2, again[k].acceleration_m_s2);
  }
  EXPECT_NE(first[9].acceleration_m_s2, other[9].acceleration_m_s2);
}

INSTANTIATE_TEST_SUITE_P(Carriers, InertialUnit, testing::Values(Carrier::kWalker, Carrier::kRobot),
                         [](const auto& carrier) {
                           return carrier.param == Carrier::kWalker ? "Walker" : "Robot";
                         });

TEST(Inertial, AtRestItMeasuresGravityUpwards) {
  const Motion standing({.start_m = {1, 2, 0}, .steps = {Stand{3.0}}, .carrier = Carrier::kRobot},
                        1);
  const auto samples = inertial_samples(standing, InertialNoise::none(), 1);
  // the robot's camera is level, with y down, and only pans
  EXPECT_NEAR((samples[300].acceleration_m_s2 - Eigen::Vector3d(0, -kGravity_m_s2, 0)).norm(), 0.0,
              1e-9);
}

TEST(Inertial, ALeftTurnIsNegativeAboutTheDownAxis) {
  const Motion turning({.steps = {TurnTo{0.5 * kPi}}, .carrier = Carrier::kRobot}, 1);
  const auto samples = inertial_samples(turning, InertialNoise::none(), 1);
  EXPECT_LT(samples[samples.size() / 2].angular_velocity_rad_s.y(), -0.5);
}

TEST(Inertial, WhiteNoiseHasItsDensityAndTheBiasItsWalk) {
  const Motion standing({.steps = {Stand{200.0}}, .carrier = Carrier::kRobot}, 1);
  const InertialNoise noise;
  const auto clean = inertial_samples(standing, InertialNoise::none(), 2);
  const auto noisy = inertial_samples(standing, noise, 2);
  const auto biases = inertial_biases(standing, noise, 2);
  double gyroscope_sum = 0.0;
  double accelerometer_sum = 0.0;
  double walk_sum = 0.0;
  const auto num_samples = static_cast<double>(clean.size());
  for (std::size_t k = 1; k < clean.size(); ++k) {
    gyroscope_sum += (noisy[k].angular_velocity_rad_s - clean[k].angular_velocity_rad_s -
                      biases[k].gyroscope_rad_s)
                         .squaredNorm();
    accelerometer_sum +=
        (noisy[k].acceleration_m_s2 - clean[k].acceleration_m_s2 - biases[k].accelerometer_m_s2)
            .squaredNorm();
    walk_sum += (biases[k].gyroscope_rad_s - biases[k - 1].gyroscope_rad_s).squaredNorm();
  }
  const double root_rate = std::sqrt(kImuRate_hz);
  EXPECT_NEAR(std::sqrt(gyroscope_sum / (3.0 * num_samples)),
              noise.gyroscope_noise_rad_s_sqrt_hz * root_rate, 5e-5);
  EXPECT_NEAR(std::sqrt(accelerometer_sum / (3.0 * num_samples)),
              noise.accelerometer_noise_m_s2_sqrt_hz * root_rate, 5e-4);
  EXPECT_NEAR(std::sqrt(walk_sum / (3.0 * num_samples)),
              noise.gyroscope_bias_walk_rad_s2_sqrt_hz / root_rate, 3e-8);
}

TEST(Inertial, IntegrationBetweenSamplesIsRefused) {
  const Motion standing({.steps = {Stand{2.0}}}, 1);
  const auto samples = inertial_samples(standing, {}, 1);
  const InertialState state = true_state(standing, 0.0, {});
  EXPECT_THROW(integrated(state, samples, {}, 0.0123), core::ContractError);
  EXPECT_THROW(integrated(state, samples, {}, 3.0), core::ContractError);
  EXPECT_THROW(integrated(true_state(standing, 1.0, {}), samples, {}, 0.5), core::ContractError);
}

// What a clean unit would say and how fast it moves, by differences of poses alone.
struct Differenced {
  Eigen::Vector3d velocity_m_s;
  Eigen::Vector3d turning_rad_s;
  Eigen::Vector3d specific_force_m_s2;
};

Differenced differenced(const Motion& motion, double stamp_s) {
  constexpr double kStep_s = 1e-3;
  const core::Rigid3 before = motion.world_from_body(stamp_s - kStep_s);
  const core::Rigid3 now = motion.world_from_body(stamp_s);
  const core::Rigid3 after = motion.world_from_body(stamp_s + kStep_s);
  const Eigen::Vector3d acceleration_m_s2 =
      (after.translation - 2.0 * now.translation + before.translation) / (kStep_s * kStep_s);
  return {(after.translation - before.translation) / (2.0 * kStep_s),
          core::log_so3(before.rotation.conjugate() * after.rotation) / (2.0 * kStep_s),
          now.rotation.conjugate() * (acceleration_m_s2 + Eigen::Vector3d(0, 0, kGravity_m_s2))};
}

TEST(Inertial, TheTruthAtAFrameIsTheVelocityAndTheBiasOfTheLastSample) {
  InertialNoise noise;
  noise.gyroscope_noise_rad_s_sqrt_hz = 0.0;
  noise.accelerometer_noise_m_s2_sqrt_hz = 0.0;
  const Motion walking(tour(Carrier::kWalker), 3);
  const auto samples = inertial_samples(walking, noise, 5);
  const auto truth = inertial_truth(walking, inertial_biases(walking, noise, 5), {2.0, 2.0667});
  ASSERT_EQ(truth.size(), 2U);
  EXPECT_EQ(truth[1].stamp_s, 2.0667);
  for (const auto& [state, sample] :
       {std::pair(truth[0], samples[400]), {truth[1], samples[413]}}) {
    EXPECT_LT((state.velocity_m_s - differenced(walking, state.stamp_s).velocity_m_s).norm(), 1e-4);
    EXPECT_GT(state.velocity_m_s.norm(), 0.5);
    const Differenced clean = differenced(walking, sample.stamp_s);
    const Eigen::Vector3d gyroscope_rad_s = sample.angular_velocity_rad_s - clean.turning_rad_s;
    EXPECT_LT((state.gyroscope_bias_rad_s - gyroscope_rad_s).norm(), 1e-4);
    EXPECT_GT(state.gyroscope_bias_rad_s.norm(), 5e-4);
    const Eigen::Vector3d accelerometer_m_s2 = sample.acceleration_m_s2 - clean.specific_force_m_s2;
    EXPECT_LT((state.accelerometer_bias_m_s2 - accelerometer_m_s2).norm(), 2e-3);
    EXPECT_GT(state.accelerometer_bias_m_s2.norm(), 1e-2);
  }
}

TEST(Inertial, TheRigTellsWhereTheUnitSitsAndHowNoisyItIs) {
  const core::Imu imu = imu_description({});
  EXPECT_EQ(imu.gyroscope_noise_rad_s_sqrt_hz, 1.7e-4);
  EXPECT_EQ(imu.accelerometer_noise_m_s2_sqrt_hz, 2.0e-3);
  EXPECT_EQ(imu.gyroscope_bias_walk_rad_s2_sqrt_hz, 1.9e-5);
  EXPECT_EQ(imu.accelerometer_bias_walk_m_s3_sqrt_hz, 3.0e-3);
  EXPECT_EQ(imu.body_from_imu.matrix(), Eigen::Matrix4d::Identity());
}

}  // namespace
}  // namespace samewhere::twin
