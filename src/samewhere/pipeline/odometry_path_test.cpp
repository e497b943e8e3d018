#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/pipeline/odometry_path.hpp>

namespace samewhere::pipeline {
namespace {

core::Rigid3 at(double x_m, double heading_rad) {
  return {core::exp_so3({0.0, 0.0, heading_rad}), {x_m, 0.0, 0.0}};
}

OdometryConfig config_of(OdometrySensor sensor = OdometrySensor::kWheel) {
  OdometryConfig config;
  config.file = "wheels.tum";
  config.sensor = sensor;
  return config;
}

// 1 m/s, a row each 0.1 s for 2 s, then none for 3 s.
input::OdometryRows with_gap() {
  input::OdometryRows rows;
  for (int i = 0; i <= 20; ++i) rows.push_back({0.1 * i, at(0.1 * i, 0.0), {}});
  for (int i = 0; i <= 10; ++i) rows.push_back({5.0 + 0.1 * i, at(5.0 + 0.1 * i, 0.0), {}});
  return rows;
}

TEST(OdometryPath, APoseBetweenRowsIsLinearInPositionAndSphericalInRotation) {
  const OdometryPath path(config_of(), {{1.0, at(0.0, 0.0), {}}, {1.4, at(2.0, 0.8), {}}});
  const core::Rigid3 pose = path.world_from_body(1.1).value();
  EXPECT_NEAR(pose.translation.x(), 0.5, 1e-12);
  EXPECT_NEAR(core::log_so3(pose.rotation).z(), 0.2, 1e-12);
}

TEST(OdometryPath, ThereIsNoPoseInALongGapNorOutside) {
  const OdometryPath path(config_of(), with_gap());
  EXPECT_TRUE(path.world_from_body(0.0));
  EXPECT_TRUE(path.world_from_body(2.0));
  EXPECT_FALSE(path.world_from_body(2.1));
  EXPECT_FALSE(path.world_from_body(4.9));
  EXPECT_TRUE(path.world_from_body(5.0));
  EXPECT_TRUE(path.world_from_body(6.0));
  EXPECT_FALSE(path.world_from_body(-0.1));
  EXPECT_FALSE(path.world_from_body(6.1));
}

TEST(OdometryPath, MotionAcrossALongGapIsLessCertainByItsDuration) {
  OdometryConfig config = config_of();
  const OdometryPath path(config, with_gap());
  config.gap_per_s = 0.0;
  config.gap_rad_per_s = 0.0;
  const OdometryPath certain(config, with_gap());
  const auto motion = path.motion(1.95, 5.05);
  EXPECT_NEAR(motion.a_from_b.translation.x(), 3.1, 1e-12);
  const core::Matrix6d extra = motion.covariance - certain.motion(1.95, 5.05).covariance;
  EXPECT_NEAR(extra(0, 0), 0.5 * 0.5 * 9.0, 1e-9);
  EXPECT_NEAR(extra(5, 5), 0.3 * 0.3 * 9.0, 1e-9);
  EXPECT_LT((path.motion(0.0, 2.0).covariance - certain.motion(0.0, 2.0).covariance).norm(), 1e-12);
}

TEST(OdometryPath, CovariancesOfTheFileAreComposed) {
  input::OdometryRows rows = with_gap();
  core::Vector6d variances;
  variances << 1e-4, 2e-4, 3e-4, 1e-6, 1e-6, 1e-6;
  for (std::size_t i = 1; i < rows.size(); ++i)
    rows[i].covariance = core::Matrix6d(variances.asDiagonal());
  const OdometryPath path(config_of(OdometrySensor::kFile), rows);
  const core::Matrix6d whole = path.motion(0.0, 1.0).covariance;
  EXPECT_NEAR(whole(0, 0), 10 * 1e-4, 2e-6) << "independent increments add up";
  EXPECT_NEAR(whole(3, 3), 10 * 1e-6, 1e-7);
  EXPECT_GT(whole(1, 1), 10 * 2e-4 + 1e-6) << "and a turn moves what comes after it";
  const core::Matrix6d half = path.motion(0.0, 0.05).covariance;
  EXPECT_NEAR(half(0, 0), 0.5e-4, 2e-6) << "of a part of an increment its share";
}

TEST(OdometryPath, SensorFileNeedsCovariances) {
  EXPECT_THROW(OdometryPath(config_of(OdometrySensor::kFile), with_gap()), core::ContractError);
}

TEST(OdometryPath, HeightIsMoreCertainThanPositionIfTheBodyTurnsAboutOneAxis) {
  input::OdometryRows rows;
  for (int i = 0; i <= 100; ++i) rows.push_back({0.1 * i, at(0.1 * i, 0.05 * i), {}});
  const core::Matrix6d turning = OdometryPath(config_of(), rows).motion(0.0, 10.0).covariance;
  EXPECT_LT(turning(2, 2), 0.05 * turning(0, 0));
  EXPECT_LT(turning(3, 3), 0.05 * turning(5, 5));
  const core::Matrix6d straight = OdometryPath(config_of(), with_gap()).motion(0.0, 2.0).covariance;
  EXPECT_NEAR(straight(2, 2), straight(0, 0), 1e-12);
}

TEST(DriftRates, SettingsReplaceThoseOfTheSensor) {
  OdometryConfig config = config_of(OdometrySensor::kLeg);
  const DriftRates leg = drift_rates(config);
  config.drift_per_metre = 0.01;
  const DriftRates set = drift_rates(config);
  EXPECT_EQ(set.bias.per_metre, 0.01);
  EXPECT_EQ(set.bias.rad_per_metre, leg.bias.rad_per_metre);
  EXPECT_TRUE(drift_rates(config_of(OdometrySensor::kFile)).bias.is_none());
  EXPECT_TRUE(systematic_drift({}).is_none()) << "without a file";
}

// A square of 4 m, with a height by time.
OdometryPath square_of(const std::function<double(int)>& height_m) {
  input::OdometryRows rows;
  for (int i = 0; i <= 40; ++i) {
    const double along_m = 0.1 * (i % 10);
    const int side = (i / 10) % 4;
    const double x = side == 0 ? along_m : side == 1 ? 1.0 : side == 2 ? 1.0 - along_m : 0.0;
    const double y = side == 0 ? 0.0 : side == 1 ? along_m : side == 2 ? 1.0 : 1.0 - along_m;
    rows.push_back(
        {0.1 * i, {core::exp_so3({0.0, 0.0, 0.1 * i}), Eigen::Vector3d(x, y, height_m(i))}, {}});
  }
  return {config_of(), rows};
}

TEST(OdometryPath, PositionsInAPlaneMeasureNoHeight) {
  const auto normal = square_of([](int) { return 0.7; }).normal_in_body(1.0);
  ASSERT_TRUE(normal);
  EXPECT_NEAR(std::abs(normal->z()), 1.0, 1e-6);
  EXPECT_FALSE(square_of([](int i) { return 0.01 * i; }).normal_in_body(1.0)) << "a screw";
  EXPECT_FALSE(square_of([](int i) { return 0.005 * (i % 3); }).normal_in_body(1.0)) << "steps";
}

TEST(OdometryPath, ALineThatTurnsAboutNoAxisHasNoPlane) {
  input::OdometryRows rows;
  for (int i = 0; i < 5; ++i) rows.push_back({0.1 * i, {{}, Eigen::Vector3d(0.1 * i, 0, 0)}, {}});
  EXPECT_FALSE(OdometryPath(config_of(), rows).normal_in_body(0.1));
}

}  // namespace
}  // namespace samewhere::pipeline
