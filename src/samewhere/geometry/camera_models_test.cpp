#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include <samewhere/core/random.hpp>
#include <samewhere/geometry/camera.hpp>

namespace samewhere::geometry {
namespace {

core::KannalaBrandt random_fisheye(core::Random& random) {
  return {640,
          480,
          random.uniform(250.0, 500.0),
          random.uniform(250.0, 500.0),
          random.uniform(300.0, 340.0),
          random.uniform(220.0, 260.0),
          random.uniform(-0.05, 0.05),
          random.uniform(-0.01, 0.01),
          random.uniform(-0.002, 0.002),
          random.uniform(-0.0005, 0.0005)};
}

// Of lenses whose picture does not turn back before its corners.
core::PinholeRadtan random_rational(core::Random& random) {
  core::PinholeRadtan c{640,   480,  random.uniform(450.0, 700.0), random.uniform(450.0, 700.0),
                        320.0, 240.0};
  c.k1 = random.uniform(-0.1, 0.4);
  c.k2 = random.uniform(-0.05, 0.1);
  c.p1 = random.uniform(-1e-3, 1e-3);
  c.p2 = random.uniform(-1e-3, 1e-3);
  c.k3 = random.uniform(-0.02, 0.02);
  c.k4 = random.uniform(0.0, 0.2);
  c.k5 = random.uniform(-0.05, 0.1);
  c.k6 = random.uniform(-0.02, 0.02);
  return c;
}

Eigen::Vector3d random_point(core::Random& random, double aside) {
  return {random.uniform(-aside, aside), random.uniform(-aside, aside), 1.0};
}

cv::Matx33d matrix_of(const core::Camera& camera) {
  const Eigen::Vector2d f = focal_lengths_px(camera);
  const Eigen::Vector2d c = centre_px(camera);
  return {f.x(), 0.0, c.x(), 0.0, f.y(), c.y(), 0.0, 0.0, 1.0};
}

void expect_near(const cv::Point2d& expected, const std::optional<Eigen::Vector2d>& found) {
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->x(), expected.x, 1e-8);
  EXPECT_NEAR(found->y(), expected.y, 1e-8);
}

TEST(CameraModels, AFisheyeProjectsAsOpenCvsDoes) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    core::Random random(seed);
    const core::KannalaBrandt c = random_fisheye(random);
    const Eigen::Vector3d point = random_point(random, 3.0);
    const std::vector<cv::Point3d> points = {{point.x(), point.y(), point.z()}};
    std::vector<cv::Point2d> pixels;
    cv::fisheye::projectPoints(points, pixels, cv::Vec3d(), cv::Vec3d(), matrix_of(c),
                               cv::Vec4d(c.k1, c.k2, c.k3, c.k4));
    expect_near(pixels[0], project(c, point));
  }
}

TEST(CameraModels, ARationalLensProjectsAsOpenCvsDoes) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    core::Random random(seed);
    const core::PinholeRadtan c = random_rational(random);
    const Eigen::Vector3d point = random_point(random, 0.6);
    const std::vector<cv::Point3d> points = {{point.x(), point.y(), point.z()}};
    std::vector<cv::Point2d> pixels;
    cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), matrix_of(c),
                      cv::Vec<double, 8>(c.k1, c.k2, c.p1, c.p2, c.k3, c.k4, c.k5, c.k6), pixels);
    expect_near(pixels[0], project(c, point));
  }
}

TEST(CameraModels, ProjectionUndoesBearing) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    core::Random random(seed);
    const std::vector<core::Camera> cameras = {random_fisheye(random), random_rational(random)};
    for (const core::Camera& camera : cameras) {
      const Eigen::Vector2d pixel(random.uniform(0, 639), random.uniform(0, 479));
      const Eigen::Vector3d direction = bearing(camera, pixel);
      EXPECT_NEAR(direction.norm(), 1.0, 1e-12);
      const auto again = project(camera, 2.5 * direction);
      ASSERT_TRUE(again);
      EXPECT_LT((*again - pixel).norm(), 1e-7);
    }
  }
}

// Half the sphere and more: the TUM-VI lens sees 195 degrees.
TEST(CameraModels, AFisheyeSeesBehindItself) {
  const core::Camera camera = core::KannalaBrandt{512, 512, 160.0, 160.0, 255.5, 255.5};
  EXPECT_LT(bearing(camera, {0.0, 255.5}).z(), 0.0);
  const auto pixel = project(camera, {-1.0, 0.0, -0.05});
  ASSERT_TRUE(pixel);
  EXPECT_LT(pixel->x(), 255.5 - 160.0 * 1.57);
  EXPECT_GT(horizontal_field_of_view_rad(camera), 3.15);
  // no pinhole does: the pixel stays at the widest angle of one
  const Eigen::Vector2d undistorted = undistort(camera, {0.0, 255.5});
  EXPECT_NEAR(std::atan((255.5 - undistorted.x()) / 160.0), kMaxPinholeAngle_rad, 1e-9);
}

TEST(CameraModels, AFisheyesMiddleIsThatOfItsPinhole) {
  core::Random random(3);
  const core::Camera camera = random_fisheye(random);
  const Eigen::Vector2d pixel = centre_px(camera) + Eigen::Vector2d(3.0, -2.0);
  EXPECT_LT((undistort(camera, pixel) - pixel).norm(), 0.01);
  EXPECT_LT((bearing_of_undistorted(camera, undistort(camera, {200.0, 100.0})) -
             bearing(camera, {200.0, 100.0}))
                .norm(),
            1e-12);
}

TEST(CameraModels, WhatIsNoNumberIsNotSeen) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  core::Random random(6);
  for (const core::Camera& camera :
       {core::Camera(random_fisheye(random)), core::Camera(random_rational(random)),
        core::Camera(core::PinholeRadtan{640, 480, 500.0, 500.0, 320.0, 240.0})}) {
    for (const double bad : {nan, inf, -inf}) {
      EXPECT_FALSE(project(camera, {bad, 0.0, 1.0}));
      EXPECT_FALSE(project(camera, {0.0, bad, 1.0}));
      EXPECT_FALSE(project_undistorted(camera, {bad, 0.0, 1.0}));
      EXPECT_FALSE(project_undistorted(camera, {0.0, bad, 1.0}));
    }
    EXPECT_FALSE(project(camera, {0.0, 0.0, nan}));
    EXPECT_FALSE(project_undistorted(camera, {0.0, 0.0, nan}));
  }
}

TEST(CameraModels, OnlyBrownsFiveCoefficientsAreUndistortedByFeature) {
  core::Random random(4);
  EXPECT_FALSE(is_brown(random_fisheye(random)));
  core::PinholeRadtan lens = random_rational(random);
  EXPECT_FALSE(is_brown(lens));
  lens.k4 = lens.k5 = lens.k6 = 0.0;
  EXPECT_TRUE(is_brown(lens));
}

}  // namespace
}  // namespace samewhere::geometry
