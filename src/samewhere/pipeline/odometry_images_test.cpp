#include <gtest/gtest.h>

#include <samewhere/pipeline/odometry_images.hpp>

namespace samewhere::pipeline {
namespace {

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

geometry::UncertainPose motion(const Eigen::Vector3d& translation, double sigma,
                               const Eigen::Vector3d& rotation = Eigen::Vector3d::Zero()) {
  return {{core::exp_so3(rotation), translation}, sigma * sigma * core::Matrix6d::Identity()};
}

OdometryMotion half_a_metre(const std::optional<Eigen::Vector3d>& normal) {
  return {.before_from_after = motion({0.5, 0.0, 0.0}, 0.003),
          .duration_s = 20.0,
          .normal_in_before = normal};
}

TEST(OdometryImages, OdometryThatMeasuresHeightStaysAsItIs) {
  const auto combined =
      combine_with_images(half_a_metre({}), motion({0.51, 0.01, 0.01}, 0.001), {});
  EXPECT_EQ(combined.a_from_b.translation, Eigen::Vector3d(0.5, 0.0, 0.0));
  EXPECT_EQ(combined.covariance, half_a_metre({}).before_from_after.covariance);
  EXPECT_FALSE(combined.is_contradicted);
}

TEST(OdometryImages, InAPlaneHeightAndTiltAreThoseOfTheImages) {
  const auto combined = combine_with_images(
      half_a_metre(kUp), motion({0.51, 0.01, 0.3}, 0.001, {0.02, 0.1, 0.003}), {});
  EXPECT_NEAR(combined.a_from_b.translation.x(), 0.5, 1e-12);
  EXPECT_NEAR(combined.a_from_b.translation.y(), 0.0, 1e-12);
  EXPECT_NEAR(combined.a_from_b.translation.z(), 0.3, 1e-12);
  const Eigen::Vector3d turned = core::log_so3(combined.a_from_b.rotation);
  EXPECT_NEAR(turned.x(), 0.02, 1e-9);
  EXPECT_NEAR(turned.y(), 0.1, 1e-9);
  EXPECT_NEAR(turned.z(), 0.0, 1e-9) << "the heading is odometry's";
  EXPECT_GT(combined.covariance(2, 2), 0.0004);
  EXPECT_LT(combined.covariance(2, 2), 0.001);
}

TEST(OdometryImages, WhatNoImageHasSeenLeavesTheHeightUnknown) {
  const auto combined = combine_with_images(half_a_metre(kUp), {}, {});
  EXPECT_GT(combined.covariance(2, 2), 20.0 * 20.0) << "20 s in a lift";
  EXPECT_LT(combined.covariance(0, 0), 0.001);
  EXPECT_LT(combine_with_images(half_a_metre({}), {}, {}).covariance(2, 2), 0.001);
}

TEST(OdometryImages, ASlippingWheelEnlargesTheCovariance) {
  const auto combined = combine_with_images(half_a_metre(kUp), motion({0.1, 0.0, 0.0}, 0.001), {});
  EXPECT_EQ(combined.a_from_b.translation.x(), 0.5);
  EXPECT_GT(combined.covariance(0, 0), 0.4 * 0.4);
  EXPECT_TRUE(combined.is_contradicted);
  EXPECT_LT(combined.covariance(1, 1), 0.001);
  verify::SystematicDrift drift;
  drift.per_metre = 0.5;
  EXPECT_LT(combine_with_images(half_a_metre(kUp), motion({0.1, 0.0, 0.0}, 0.001), drift)
                .covariance(0, 0),
            0.001)
      << "the drift model knows it";
}

TEST(OdometryImages, InAGapTheMotionIsThatOfTheImages) {
  OdometryMotion odometry = half_a_metre({});
  odometry.has_gap = true;
  const auto combined = combine_with_images(odometry, motion({0.1, 0.2, 0.3}, 0.001), {});
  EXPECT_EQ(combined.a_from_b.translation, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_GT(combined.covariance(0, 0), 0.02 * 0.02);
}

}  // namespace
}  // namespace samewhere::pipeline
