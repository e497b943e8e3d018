#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/stereo_pair.hpp>

namespace samewhere::input {
namespace {

using ::testing::HasSubstr;

constexpr double kFocalLength_px = 400.0;
constexpr double kBaseline_m = 0.12;

messages::CameraInfo info_with(const core::Rigid3& rectified_from_raw, double p3) {
  messages::CameraInfo info;
  const Eigen::Matrix4d matrix = rectified_from_raw.matrix();
  for (int i = 0; i < 9; ++i) info.r[static_cast<std::size_t>(i)] = matrix(i / 3, i % 3);
  info.p = {kFocalLength_px, 0, 320, p3, 0, kFocalLength_px, 240, 0, 0, 0, 1, 0};
  return info;
}

core::Rigid3 turned(double x_rad, double y_rad, double z_rad) {
  return {.rotation = core::exp_so3({x_rad, y_rad, z_rad})};
}

// A calibration made forwards: cameras that are turned and apart, and the axes between them whose x
// goes from the left to the right camera.
TEST(StereoPair, RawPicturesHangTogetherByRAndP) {
  const core::Rigid3 rectified_from_left = turned(0.1, -0.05, 0.2);
  const core::Rigid3 rectified_from_right = turned(-0.02, 0.3, 0.01);
  const auto left_from_right_told =
      left_from_right(info_with(rectified_from_left, 0.0),
                      info_with(rectified_from_right, -kFocalLength_px * kBaseline_m), false);
  ASSERT_TRUE(left_from_right_told);
  const Eigen::Vector3d x_in_right(0.3, -0.2, 4.0);
  const Eigen::Vector3d x_in_rectified =
      rectified_from_right.rotation * x_in_right + Eigen::Vector3d(kBaseline_m, 0, 0);
  const Eigen::Vector3d x_in_left = rectified_from_left.rotation.inverse() * x_in_rectified;
  EXPECT_LT((*left_from_right_told * x_in_right - x_in_left).norm(), 1e-12);
}

TEST(StereoPair, RectifiedPicturesAreApartAlongX) {
  const auto told =
      left_from_right(info_with(turned(0.1, 0.2, 0.3), 0.0),
                      info_with(turned(0.3, 0.2, 0.1), -kFocalLength_px * kBaseline_m), true);
  ASSERT_TRUE(told);
  EXPECT_LT((told->translation - Eigen::Vector3d(kBaseline_m, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(core::angle_rad(told->rotation), 0.0);
}

TEST(StereoPair, RotationsOfZerosTurnNothing) {
  messages::CameraInfo left = info_with({}, 0.0);
  messages::CameraInfo right = info_with({}, -kFocalLength_px * kBaseline_m);
  left.r = {};
  right.r = {};
  const auto told = left_from_right(left, right, false);
  ASSERT_TRUE(told);
  EXPECT_NEAR(told->translation.x(), kBaseline_m, 1e-12);
  EXPECT_EQ(core::angle_rad(told->rotation), 0.0);
}

TEST(StereoPair, WithoutADistanceThereIsNone) {
  const messages::CameraInfo left = info_with({}, 0.0);
  messages::CameraInfo right = info_with({}, 0.0);
  EXPECT_THAT(left_from_right(left, right, true).error(), HasSubstr("P[3] of the right camera"));
  right.p[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(left_from_right(left, right, true));
  right.p = {};
  right.p[3] = -40.0;
  EXPECT_FALSE(left_from_right(left, right, true)) << "focal length 0";
}

TEST(StereoPair, WhatIsNoRotationIsRefused) {
  messages::CameraInfo left = info_with({}, 0.0);
  messages::CameraInfo right = info_with({}, -40.0);
  right.r[0] = 2.0;
  EXPECT_THAT(left_from_right(left, right, false).error(), HasSubstr("R of the right camera"));
  EXPECT_TRUE(left_from_right(left, right, true)) << "R is not used";
  left.r[4] = -1.0;
  EXPECT_THAT(left_from_right(left, right, false).error(), HasSubstr("R of the left camera"));
  left.r[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(left_from_right(left, right, false));
}

}  // namespace
}  // namespace samewhere::input
