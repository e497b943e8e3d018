#include <cmath>

#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/optimize/manifold.hpp>
#include <samewhere/track/depth_alignment.hpp>

namespace samewhere::track {
namespace {

const core::PinholeRadtan kCamera{.width_px = 640,
                                  .height_px = 480,
                                  .fx_px = 500.0,
                                  .fy_px = 500.0,
                                  .cx_px = 319.5,
                                  .cy_px = 239.5,
                                  .k1 = 0.05};
constexpr DepthAlignmentConfig kConfig;

// n . x = distance_m
struct Plane {
  Eigen::Vector3d normal;
  double distance_m;
};

// A corner of a room, without a spot of texture: floor, two walls.
const std::vector<Plane> kCorner = {
    {{0.0, 1.0, 0.0}, 1.2}, {{0.6, 0.0, 0.8}, 2.5}, {{-0.8, 0.0, 0.6}, 2.5}};

// What a camera sees of the nearest planes in front of it.
cv::Mat depth_of(const std::vector<Plane>& planes, const core::Rigid3& world_from_camera) {
  cv::Mat depth_m = cv::Mat::zeros(kCamera.height_px, kCamera.width_px, CV_32F);
  for (int y = 0; y < depth_m.rows; ++y) {
    for (int x = 0; x < depth_m.cols; ++x) {
      const Eigen::Vector3d ray = geometry::bearing(kCamera, Eigen::Vector2d(x, y));
      double nearest_m = 8.0;
      for (const Plane& plane : planes) {
        const double slope = plane.normal.dot(world_from_camera.rotation * ray);
        const double way_m =
            (plane.distance_m - plane.normal.dot(world_from_camera.translation)) / slope;
        if (slope > 0.0) nearest_m = std::min(nearest_m, way_m * ray.z());
      }
      if (nearest_m < 8.0) depth_m.at<float>(y, x) = static_cast<float>(nearest_m);
    }
  }
  return depth_m;
}

core::Rigid3 small_step() {
  return core::exp_r3so3((core::Vector6d() << 0.04, -0.02, 0.06, 0.01, -0.03, 0.02).finished());
}

TEST(DepthAlignment, ABareCornerTellsHowTheCameraMoved) {
  const core::Rigid3 step = small_step();
  const auto found = align({depth_of(kCorner, {}), kCamera}, {depth_of(kCorner, step), kCamera},
                           core::Rigid3{}, kConfig);
  ASSERT_TRUE(found);
  const core::Rigid3 off = inverse(step) * found->earlier_from_later;
  EXPECT_LT(off.translation.norm(), 0.003);
  EXPECT_LT(core::angle_rad(off.rotation), 0.002);
  EXPECT_GT(found->share_of_inliers, 0.95);
}

TEST(DepthAlignment, OneWallOrACorridorLeavesTheWayAlongItOpen) {
  const std::vector<Plane> wall = {kCorner[1]};
  const std::vector<Plane> corridor = {kCorner[0], {{1.0, 0.0, 0.0}, 0.9}, {{-1.0, 0.0, 0.0}, 0.9}};
  for (const auto& planes : {wall, corridor}) {
    const cv::Mat depth_m = depth_of(planes, {});
    EXPECT_FALSE(align({depth_m, kCamera}, {depth_m, kCamera}, core::Rigid3{}, kConfig));
  }
}

// As a depth camera with structured light errs: more with the square of the depth, and in steps of
// its disparity.
cv::Mat noisy(cv::Mat depth_m, std::uint64_t seed) {
  constexpr double kFocalByBaseline = 60.0;  // pixels times metres
  constexpr double kStep_px = 0.125;
  core::Random random(seed);
  for (int y = 0; y < depth_m.rows; ++y) {
    for (int x = 0; x < depth_m.cols; ++x) {
      auto& z = depth_m.at<float>(y, x);
      if (!(z > 0.0F)) continue;
      const double measured = z + 0.0015 * z * z * random.gaussian();
      const double steps = std::round(kFocalByBaseline / measured / kStep_px);
      z = static_cast<float>(kFocalByBaseline / (steps * kStep_px));
    }
  }
  return depth_m;
}

TEST(DepthAlignment, NoiseIsNoStructure) {
  const std::vector<Plane> corridor = {kCorner[0], {{1.0, 0.0, 0.0}, 0.9}, {{-1.0, 0.0, 0.0}, 0.9}};
  core::Rigid3 aside;
  aside.translation = {0.05, 0.0, 0.05};
  std::uint64_t seed = 0;
  for (const double distance_m : {1.0, 2.0, 3.0, 4.0}) {
    const std::vector<Plane> wall = {{kCorner[1].normal, distance_m}};
    for (const auto& planes : {wall, corridor}) {
      const Surfaces earlier(noisy(depth_of(planes, {}), ++seed), kCamera);
      const Surfaces later(noisy(depth_of(planes, aside), ++seed), kCamera);
      EXPECT_FALSE(align(earlier, later, core::Rigid3{}, kConfig)) << distance_m << " m";
    }
  }
  const core::Rigid3 step = small_step();
  const auto found = align({noisy(depth_of(kCorner, {}), 20), kCamera},
                           {noisy(depth_of(kCorner, step), 21), kCamera}, core::Rigid3{}, kConfig);
  ASSERT_TRUE(found) << "a corner is one with noise, too";
  EXPECT_LT((inverse(step) * found->earlier_from_later).translation.norm(), 0.005);
}

// A board of 1 m before the corner moves aside by itself.
cv::Mat with_board(cv::Mat depth_m, int first_column, int width_px) {
  depth_m(cv::Rect(first_column, 60, width_px, 300)).setTo(1.0F);
  return depth_m;
}

TEST(DepthAlignment, WhatMovesByItselfIsLeftOut) {
  const core::Rigid3 step = small_step();
  const Surfaces earlier(with_board(depth_of(kCorner, {}), 200, 120), kCamera);
  const Surfaces later(with_board(depth_of(kCorner, step), 250, 120), kCamera);
  const auto found =
      align(earlier, later, core::Rigid3{}, DepthAlignmentConfig{.min_agreement = 0.5});
  ASSERT_TRUE(found);
  EXPECT_LT((inverse(step) * found->earlier_from_later).translation.norm(), 0.01);
  EXPECT_FALSE(align(earlier, later, core::Rigid3{}, DepthAlignmentConfig{.min_agreement = 0.999}))
      << "not all agrees";
}

TEST(DepthAlignment, WithoutDepthThereIsNone) {
  const Surfaces unknown(cv::Mat::zeros(kCamera.height_px, kCamera.width_px, CV_32F), kCamera);
  const Surfaces corner(depth_of(kCorner, {}), kCamera);
  EXPECT_FALSE(align(corner, unknown, core::Rigid3{}, DepthAlignmentConfig{.min_agreement = 0.0}));
  EXPECT_FALSE(align(unknown, corner, core::Rigid3{}, DepthAlignmentConfig{.min_agreement = 0.0}));
}

// By drawing errors of the alignment and looking where they put the later camera.
TEST(DepthAlignment, TheCovarianceOfTheLaterCameraIsThatOfItsErrors) {
  core::Random random(4);
  Alignment alignment{small_step(), {}, 1.0};
  core::Matrix6d root;
  for (double& value : root.reshaped()) value = 1e-4 * random.gaussian();
  alignment.covariance = root * root.transpose();
  const core::Rigid3 earlier_from_reference =
      core::exp_r3so3((core::Vector6d() << 2.0, -1.0, 3.0, 0.5, 0.2, -0.4).finished());
  const core::Rigid3 later = inverse(alignment.earlier_from_later) * earlier_from_reference;
  core::Matrix6d by = core::Matrix6d::Zero();
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const core::Rigid3 moved =
        inverse(optimize::retract(alignment.earlier_from_later, kStep * core::Vector6d::Unit(i))) *
        earlier_from_reference;
    by.col(i).head<3>() = (moved.translation - later.translation) / kStep;
    by.col(i).tail<3>() = core::log_so3(moved.rotation * later.rotation.conjugate()) / kStep;
  }
  const core::Matrix6d expected = by * alignment.covariance * by.transpose();
  EXPECT_LT((covariance_of_later(alignment, later) - expected).norm(), 1e-4 * expected.norm());
}

}  // namespace
}  // namespace samewhere::track
