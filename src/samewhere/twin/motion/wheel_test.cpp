#include <cmath>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/building/angles.hpp>
#include <samewhere/twin/motion/wheel.hpp>

namespace samewhere::twin {
namespace {

Route robot_route(const std::vector<Step>& steps) {
  return {.start_m = {1.0, -2.0, 0.0},
          .start_heading_rad = 0.5,
          .steps = steps,
          .carrier = Carrier::kRobot,
          .speed_m_s = 0.8,
          .camera_height_m = 0.6};
}

// About 37 m and eight turns.
Route round_trip() {
  return robot_route({WalkTo{{8, 0, 0}}, WalkTo{{8, 6, 0}}, WalkTo{{1, 6, 0}}, Stand{2.0},
                      TurnTo{0.0}, TurnTo{kPi}, WalkTo{{1, -2, 0}}, WalkTo{{5, -4, 0}}});
}

struct Reckoned {
  Eigen::Vector2d position_m = Eigen::Vector2d(1.0, -2.0);
  double heading_rad = 0.5;
  double forward_m = 0.0;
};

Reckoned dead_reckoned(const std::vector<WheelSample>& samples, Reckoned now = {}) {
  for (const WheelSample& sample : samples) {
    const double middle_rad = now.heading_rad + 0.5 * sample.turned_rad;
    now.position_m +=
        sample.forward_m * Eigen::Vector2d(std::cos(middle_rad), std::sin(middle_rad));
    now.heading_rad += sample.turned_rad;
    now.forward_m += sample.forward_m;
  }
  return now;
}

TEST(Wheels, CleanSamplesLeadAlongTheWholeWay) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Motion motion(round_trip(), seed);
    const auto samples = wheel_samples(motion, WheelNoise::none(), 1);
    const Reckoned begin = {motion.floor_position_m(0.0).head<2>(), motion.heading_rad(0.0)};
    for (std::size_t num_samples = 100; num_samples < samples.size(); num_samples += 100) {
      const Reckoned there =
          dead_reckoned({samples.begin(), samples.begin() + static_cast<long>(num_samples)}, begin);
      const double stamp_s = samples[num_samples - 1].stamp_s;
      ASSERT_LT((there.position_m - motion.floor_position_m(stamp_s).head<2>()).norm(), 0.02)
          << "seed " << seed << ", " << stamp_s << " s";
      ASSERT_NEAR(there.heading_rad, motion.heading_rad(stamp_s), 1e-6);
    }
  }
}

TEST(Wheels, ComeFiftyTimesASecondAndRestWhereTheRobotStands) {
  const Motion motion(robot_route({Stand{2.0}, WalkTo{{4, -2, 0}}, Stand{2.0}}), 1);
  const auto samples = wheel_samples(motion, {}, 1);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    ASSERT_DOUBLE_EQ(samples[k].stamp_s, static_cast<double>(k + 1) / 50.0);
    if (samples[k].stamp_s < 1.7) {
      ASSERT_EQ(samples[k].forward_m, 0.0);
      ASSERT_EQ(samples[k].turned_rad, 0.0);
    }
  }
  EXPECT_EQ(samples.back().forward_m, 0.0);
  EXPECT_NEAR(samples.back().stamp_s, motion.duration_s(), 0.02);
}

TEST(Wheels, OnARampTheyRollAlongTheRamp) {
  Route route = robot_route({WalkTo{{11, -2, 1.0}}});
  route.start_heading_rad = 0.0;
  const auto samples = wheel_samples(Motion(route, 1), WheelNoise::none(), 1);
  EXPECT_NEAR(dead_reckoned(samples).forward_m, std::hypot(10.0, 1.0), 0.01);
}

TEST(Wheels, ErrorsGrowWithTheDistanceAsTheirNoiseSays) {
  const Motion motion(
      robot_route({WalkTo{{1.0 + 20.0 * std::cos(0.5), -2.0 + 20.0 * std::sin(0.5), 0.0}}}), 1);
  WheelNoise noise = WheelNoise::none();
  noise.forward_noise_m_sqrt_m = 5e-3;
  noise.turn_noise_rad_sqrt_m = 5e-3;
  WheelNoise scale = WheelNoise::none();
  scale.forward_scale_ratio = 0.01;
  constexpr int kNumSeeds = 200;
  double forward_m2 = 0.0;
  double turned_rad2 = 0.0;
  double scaled_m2 = 0.0;
  for (std::uint64_t seed = 0; seed < kNumSeeds; ++seed) {
    const Reckoned noisy = dead_reckoned(wheel_samples(motion, noise, seed));
    forward_m2 += std::pow(noisy.forward_m - 20.0, 2.0) / kNumSeeds;
    turned_rad2 += std::pow(noisy.heading_rad - 0.5, 2.0) / kNumSeeds;
    const Reckoned scaled = dead_reckoned(wheel_samples(motion, scale, seed));
    scaled_m2 += std::pow(scaled.forward_m - 20.0, 2.0) / kNumSeeds;
  }
  EXPECT_NEAR(std::sqrt(forward_m2), 5e-3 * std::sqrt(20.0), 0.003);
  EXPECT_NEAR(std::sqrt(turned_rad2), 5e-3 * std::sqrt(20.0), 0.003);
  EXPECT_NEAR(std::sqrt(scaled_m2), 0.01 * 20.0, 0.03);
}

TEST(Wheels, ASlipAddsDistanceNowAndThen) {
  const Motion motion(round_trip(), 1);
  WheelNoise noise = WheelNoise::none();
  noise.slips_per_m = 0.1;
  noise.slip_duration_s = 0.3;
  noise.largest_slip_ratio = 0.3;
  const auto clean = wheel_samples(motion, WheelNoise::none(), 1);
  int num_slipping = 0;
  int num_seeds_with_slips = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto slipping = wheel_samples(motion, noise, seed);
    const int num_before = num_slipping;
    for (std::size_t k = 0; k < clean.size(); ++k) {
      EXPECT_GE(slipping[k].forward_m, std::min(clean[k].forward_m, 1.3 * clean[k].forward_m));
      EXPECT_LE(slipping[k].forward_m, std::max(clean[k].forward_m, 1.3 * clean[k].forward_m));
      num_slipping += slipping[k].forward_m > 1.001 * clean[k].forward_m ? 1 : 0;
    }
    num_seeds_with_slips += num_slipping > num_before ? 1 : 0;
  }
  EXPECT_GT(num_seeds_with_slips, 15);
  EXPECT_LT(num_slipping, 0.15 * 20.0 * static_cast<double>(clean.size()));
}

TEST(Wheels, TheSameSeedGivesTheSameBytesAndAnotherDoesNot) {
  const Motion motion(round_trip(), 1);
  const auto first = wheel_samples(motion, {}, 1);
  const auto again = wheel_samples(motion, {}, 1);
  const auto other = wheel_samples(motion, {}, 2);
  ASSERT_EQ(first.size(), again.size());
  for (std::size_t k = 0; k < first.size(); ++k) {
    ASSERT_EQ(first[k].forward_m, again[k].forward_m);
    ASSERT_EQ(first[k].turned_rad, again[k].turned_rad);
  }
  EXPECT_NE(dead_reckoned(first).forward_m, dead_reckoned(other).forward_m);
}

TEST(Wheels, AreNotAPersons) {
  Route route = round_trip();
  route.carrier = Carrier::kWalker;
  EXPECT_THROW(wheel_samples(Motion(route, 1), {}, 1), core::ContractError);
}

}  // namespace
}  // namespace samewhere::twin
