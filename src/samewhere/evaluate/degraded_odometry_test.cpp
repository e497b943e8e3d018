#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/evaluate/degraded_odometry.hpp>
#include <samewhere/evaluate/drift_at_return.hpp>

namespace samewhere::evaluate {
namespace {

// 100 m along x, and back after a turn on the spot, at 1 m/s and 10 Hz.
core::Trajectory there_and_back() {
  core::Trajectory truth;
  const auto add = [&](double x_m, double heading_rad) {
    truth.push_back({0.1 * static_cast<double>(truth.size()),
                     {core::exp_so3({0.0, 0.0, heading_rad}), Eigen::Vector3d(x_m, 0.0, 0.0)}});
  };
  for (int i = 0; i <= 1000; ++i) add(0.1 * i, 0.0);
  for (int i = 1; i <= 62; ++i) add(100.0, std::numbers::pi * i / 62.0);
  for (int i = 1000; i >= 0; --i) add(0.1 * i, std::numbers::pi);
  return truth;
}

double error_at_m(const core::Trajectory& truth, const core::Trajectory& odometry, std::size_t i) {
  return (truth[i].world_from_camera.translation - odometry[i].world_from_camera.translation)
      .norm();
}

TEST(DegradedOdometry, AShareOfTheDistanceIsOffAfterAHundredMetres) {
  const core::Trajectory truth = there_and_back();
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const core::Trajectory odometry = degraded(truth, degradation_of("5%"), seed);
    ASSERT_EQ(odometry.size(), truth.size());
    EXPECT_NEAR(error_at_m(truth, odometry, 1000), 5.0, 1.0) << "seed " << seed;
  }
}

TEST(DegradedOdometry, TheHeadingDriftsByDegreesPerMetre) {
  const core::Trajectory truth = there_and_back();
  const core::Trajectory odometry = degraded(truth, degradation_of("0.5deg/m"), 1);
  EXPECT_NEAR(core::angle_rad(odometry[1000].world_from_camera.rotation), 0.873, 0.1);
}

TEST(DegradedOdometry, TheSameSeedGivesTheSameBitsAndAnotherDoesNot) {
  const core::Trajectory truth = there_and_back();
  const Degradation poor = degradation_of("2%+slip");
  const auto end = [&](std::uint64_t seed) {
    return degraded(truth, poor, seed).back().world_from_camera.translation;
  };
  EXPECT_EQ(end(1), end(1));
  EXPECT_NE(end(1), end(2));
}

TEST(DegradedOdometry, AnOutageLeavesOutFiveSecondsOfRows) {
  const core::Trajectory odometry = degraded(there_and_back(), degradation_of("outage"), 4);
  double longest_s = 0.0;
  for (std::size_t i = 1; i < odometry.size(); ++i)
    longest_s = std::max(longest_s, odometry[i].stamp_s - odometry[i - 1].stamp_s);
  EXPECT_GE(longest_s, 5.0);
}

TEST(DegradedOdometry, ALiftRideHasNoHeight) {
  core::Trajectory truth = there_and_back();
  for (std::size_t i = 0; i < truth.size(); ++i)
    truth[i].world_from_camera.translation.z() = i < 1000 ? 0.0 : 3.0;
  const core::Trajectory odometry = degraded(truth, degradation_of("lift"), 1);
  EXPECT_NEAR(odometry.back().world_from_camera.translation.z(), 0.0, 0.05);
}

TEST(DegradedOdometry, AnUnknownKindIsAnError) {
  for (const char* kinds : {"", "5", "bad", "0%", "-1%", "200%", "1deg", "5%+", "deg/m"})
    EXPECT_THROW(degradation_of(kinds), core::InputError) << kinds;
  const Degradation both = degradation_of("5%+outage");
  EXPECT_EQ(both.distance_ratio, 0.05);
  EXPECT_TRUE(both.has_outages);
}

TEST(DriftAtFirstReturn, IsMeasuredFromTheEarlierVisit) {
  core::Trajectory truth = there_and_back();
  for (auto& pose : truth)  // looks the same way on the way back
    pose.world_from_camera.rotation = Eigen::Quaterniond::Identity();
  core::Trajectory odometry = truth;
  for (std::size_t i = 1010; i < odometry.size(); ++i)
    odometry[i].world_from_camera.translation.y() += 0.7;
  const auto drift = drift_at_first_return(truth, odometry).value();
  EXPECT_NEAR(drift.drift_m, 0.7, 1e-9);
  EXPECT_NEAR(drift.path_m, 5.0, 0.5);
  EXPECT_FALSE(drift_at_first_return(there_and_back(), there_and_back()))
      << "the other way round it is not the same view";
  EXPECT_GT(drift_at_first_return(truth, odometry, 180.0)->stamp_s, 179.9);
}

}  // namespace
}  // namespace samewhere::evaluate
