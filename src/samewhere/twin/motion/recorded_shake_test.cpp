#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/twin/building/angles.hpp>
#include <samewhere/twin/motion/motion.hpp>
#include <samewhere/twin/motion/recorded_shake.hpp>

namespace samewhere::twin {
namespace {

constexpr double kStepRate_rad_s = 2.0 * kPi * 1.8;
constexpr double kLookRate_rad_s = 2.0 * kPi * 0.25;
constexpr double kDuration_s = 30.0;

double bob_m(double stamp_s) { return 0.02 * std::sin(kStepRate_rad_s * stamp_s); }
double look_rad(double stamp_s) { return 0.2 * std::sin(kLookRate_rad_s * stamp_s); }
double tilt_rad(double stamp_s) { return 0.1 * std::sin(kLookRate_rad_s * stamp_s + 1.0); }

Eigen::Quaterniond about(const Eigen::Vector3d& axis, double angle_rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis));
}

// Straight on at `speed_m_s`, with steps, looking around and up and down. The axes of the body may
// be any.
core::Trajectory recorded_walk(double heading_rad, const Eigen::Quaterniond& level_from_body,
                               double speed_m_s = 1.3) {
  core::Trajectory walk;
  for (int k = 0; k <= 600; ++k) {
    const double t = k / 20.0;
    const Eigen::Quaterniond way = about(Eigen::Vector3d::UnitZ(), heading_rad);
    const Eigen::Quaterniond turned = about(Eigen::Vector3d::UnitZ(), look_rad(t)) *
                                      about(Eigen::Vector3d::UnitY(), -tilt_rad(t));
    walk.push_back({1000.0 + t,
                    {way * turned * level_from_body,
                     way * Eigen::Vector3d(speed_m_s * t, 0.0, 1.5 + bob_m(t))}});
  }
  return walk;
}

Route straight_on(Carrier carrier) {
  return {.steps = {WalkTo{{40.0, 0.0, 0.0}}},
          .carrier = carrier,
          .speed_m_s = 1.3,
          .camera_height_m = 1.5};
}

TEST(RecordedShake, StepsAndLooksAreThoseOfTheRecordingWhateverItsAxes) {
  for (const double heading_rad : {0.0, 2.0, -3.0}) {
    for (const Eigen::Vector3d& axes :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1.2, -0.4, 2.1)}) {
      const RecordedShake shake(recorded_walk(heading_rad, core::exp_so3(axes)));
      EXPECT_NEAR(shake.duration_s(), kDuration_s, 1e-6);
      for (double t = 3.0; t < kDuration_s - 3.0; t += 0.13) {
        SCOPED_TRACE(testing::Message() << heading_rad << " rad, " << t << " s");
        const auto values = shake.at(t);
        ASSERT_NEAR(values[kShakeUp].value, bob_m(t), 0.002);
        ASSERT_NEAR(values[kShakeForward].value, 0.0, 1e-6);
        ASSERT_NEAR(values[kShakeLeft].value, 0.0, 1e-6);
        ASSERT_NEAR(values[kShakeYaw].value, look_rad(t), 0.01);
        ASSERT_NEAR(values[kShakePitch].value, tilt_rad(t), 0.01);
        ASSERT_NEAR(values[kShakeRoll].value, 0.0, 0.02);
      }
    }
  }
}

TEST(RecordedShake, RunsBackwardsBeyondItsEnds) {
  const RecordedShake shake(recorded_walk(0.3, Eigen::Quaterniond::Identity()));
  for (const double t : {0.02, 0.4, 7.31}) {
    for (std::size_t channel = 0; channel < kShakeChannels; ++channel) {
      EXPECT_NEAR(shake.at(-t)[channel].value, shake.at(t)[channel].value, 1e-12);
      EXPECT_NEAR(shake.at(kDuration_s + t)[channel].value,
                  shake.at(kDuration_s - t)[channel].value, 1e-9);
      EXPECT_NEAR(shake.at(-t)[channel].first, -shake.at(t)[channel].first, 1e-9);
    }
  }
}

TEST(RecordedShake, HasLimits) {
  core::Trajectory wild = recorded_walk(0.0, Eigen::Quaterniond::Identity());
  for (std::size_t i = 100; i < 104; ++i) {
    wild[i].world_from_camera.translation.y() += 3.0;
    wild[i].world_from_camera.rotation =
        wild[i].world_from_camera.rotation * about(Eigen::Vector3d::UnitZ(), 2.0);
  }
  const RecordedShake shake(wild);
  for (double t = 0.0; t < kDuration_s; t += 0.01) {
    ASSERT_LT(std::abs(shake.at(t)[kShakeLeft].value), kMostShake_m + 1e-9);
    ASSERT_LT(std::abs(shake.at(t)[kShakeYaw].value), kMostShake_rad + 1e-9);
  }
}

TEST(RecordedShake, NoneIsNoMotion) {
  const RecordedShake none;
  EXPECT_TRUE(none.is_empty());
  for (const Jet& jet : none.at(3.0)) EXPECT_EQ(jet.value, 0.0);
}

std::string why_no_walk(const core::Trajectory& trajectory) {
  try {
    const RecordedShake shake(trajectory);
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(RecordedShake, WhatIsNoWalkIsRefused) {
  const core::Trajectory walk = recorded_walk(0.0, Eigen::Quaterniond::Identity());
  EXPECT_EQ(why_no_walk({}), "found 0 poses over 0.0 s, expected 10 s at least");
  EXPECT_EQ(why_no_walk({walk.begin(), walk.begin() + 101}),
            "found 101 poses over 5.0 s, expected 10 s at least");
  core::Trajectory cut = walk;
  cut.erase(cut.begin() + 200, cut.begin() + 220);
  EXPECT_EQ(why_no_walk(cut),
            "found no pose for 1.05 s after stamp 1009.950000, expected one every 0.5 s at least");
  EXPECT_EQ(why_no_walk(recorded_walk(0.0, Eigen::Quaterniond::Identity(), 0.1)),
            "found 0 % of the time at 0.2 m/s or faster, expected a walk: 50 %");
}

TEST(RecordedShake, AWalkerMovesAsRecordedAndARobotDoesNot) {
  const RecordedShake shake(recorded_walk(1.0, core::exp_so3({0.5, 0.1, -1.0})));
  const Motion made_up(straight_on(Carrier::kWalker), 3);
  const Motion recorded(straight_on(Carrier::kWalker), 3, {}, shake);
  double lowest_m = 10.0;
  double highest_m = 0.0;
  for (double t = 5.0; t < 25.0; t += 0.02) {
    EXPECT_EQ(made_up.floor_position_m(t), recorded.floor_position_m(t));
    const double height_m = recorded.world_from_body(t).translation.z();
    lowest_m = std::min(lowest_m, height_m);
    highest_m = std::max(highest_m, height_m);
  }
  EXPECT_NEAR(highest_m - lowest_m, 0.04, 0.006);
  const Motion robot(straight_on(Carrier::kRobot), 3);
  const Motion robot_with(straight_on(Carrier::kRobot), 3, {}, shake);
  EXPECT_EQ(robot.world_from_body(9.0).translation, robot_with.world_from_body(9.0).translation);
}

// Of a person, by a recording of three storeys.
TEST(RecordedShake, ARealWalkLooksAroundMoreThanItTiltsAndStepsByCentimetres) {
  const char* const data = std::getenv("SAMEWHERE_DATA");
  if (data == nullptr) GTEST_SKIP() << "set SAMEWHERE_DATA to the folder of the recordings";
  const RecordedShake shake(core::read_tum(
      std::filesystem::path(data) / "paths" / "three_storeys.txt", core::MoreColumns::kSkipped));
  std::array<double, kShakeChannels> squares{};
  int num_samples = 0;
  for (double t = 0.0; t < shake.duration_s(); t += 0.05, ++num_samples) {
    const auto values = shake.at(t);
    for (std::size_t i = 0; i < kShakeChannels; ++i) squares[i] += std::pow(values[i].value, 2);
  }
  const auto rms = [&](ShakeChannel channel) { return std::sqrt(squares[channel] / num_samples); };
  for (const ShakeChannel channel : {kShakeForward, kShakeLeft, kShakeUp}) {
    EXPECT_GT(rms(channel), 0.005);
    EXPECT_LT(rms(channel), 0.06);
  }
  EXPECT_GT(rms(kShakeYaw), rms(kShakePitch));
  EXPECT_GT(rms(kShakePitch), rms(kShakeRoll));
  EXPECT_LT(rms(kShakeRoll), 5.0 * kDegree_rad);
}

TEST(RecordedShake, DerivativesOfTheMotionAreThoseOfThePose) {
  constexpr double kStep_s = 1e-4;
  const Motion motion(straight_on(Carrier::kWalker), 4, {},
                      RecordedShake(recorded_walk(0.0, Eigen::Quaterniond::Identity())));
  for (double t = 0.05; t < motion.duration_s(); t += 0.0317) {
    SCOPED_TRACE(testing::Message() << t << " s");
    const core::Rigid3 before = motion.world_from_body(t - kStep_s);
    const core::Rigid3 after = motion.world_from_body(t + kStep_s);
    const Eigen::Vector3d velocity_m_s = (after.translation - before.translation) / (2.0 * kStep_s);
    const Eigen::Vector3d acceleration_m_s2 =
        (motion.velocity_m_s(t + kStep_s) - motion.velocity_m_s(t - kStep_s)) / (2.0 * kStep_s);
    ASSERT_LT((velocity_m_s - motion.velocity_m_s(t)).norm(), 1e-4);
    ASSERT_LT((acceleration_m_s2 - motion.acceleration_m_s2(t)).norm(), 2e-2);
  }
}

TEST(RecordedShake, AnotherSeedBeginsElsewhereInTheRecording) {
  const RecordedShake shake(recorded_walk(0.0, Eigen::Quaterniond::Identity()));
  const auto height_m = [&](std::uint64_t seed) {
    return Motion(straight_on(Carrier::kWalker), seed, {}, shake).world_from_body(9.0).translation;
  };
  EXPECT_EQ(height_m(1), height_m(1));
  EXPECT_NE(height_m(1).z(), height_m(2).z());
}

}  // namespace
}  // namespace samewhere::twin
