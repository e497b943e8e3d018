#include <numbers>

#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/geometry/camera.hpp>

namespace samewhere::geometry {
namespace {

// The published calibration of the first Freiburg camera: strong distortion.
core::PinholeRadtan strong_camera() {
  return {640, 480, 517.3, 516.5, 318.6, 255.3, 0.2624, -0.9531, -0.0054, 0.0026, 1.1633};
}

TEST(Camera, UndistortingUndoesProjectionAllOverThePicture) {
  const core::Camera camera = strong_camera();
  for (int x = 0; x < 640; x += 16) {
    for (int y = 0; y < 480; y += 16) {
      const Eigen::Vector2d pixel(x, y);
      const auto again = project(camera, 3.7 * bearing(camera, pixel));
      ASSERT_TRUE(again);
      EXPECT_LT((*again - pixel).norm(), 1e-6) << pixel.transpose();
    }
  }
}

TEST(Camera, WithoutDistortionItIsThePinholeOfEquation17) {
  const core::Camera camera = core::PinholeRadtan{640, 480, 500.0, 510.0, 320.0, 240.0};
  const auto pixel = project(camera, {0.5, -0.25, 2.0});
  ASSERT_TRUE(pixel);
  EXPECT_DOUBLE_EQ(pixel->x(), 500.0 * 0.25 + 320.0);
  EXPECT_DOUBLE_EQ(pixel->y(), 510.0 * -0.125 + 240.0);
  EXPECT_EQ(undistort(camera, *pixel), *pixel);
}

TEST(Camera, TheCalibrationMatrixProjectsAsThePinholeDoes) {
  const Eigen::Vector3d point(0.5, -0.25, 2.0);
  const Eigen::Vector3d homogeneous = calibration_matrix(strong_camera()) * point;
  EXPECT_LT((homogeneous.hnormalized() - *project_undistorted(strong_camera(), point)).norm(),
            1e-9);
}

TEST(Camera, WhatIsBehindIsNotSeen) {
  EXPECT_FALSE(project(strong_camera(), {0.0, 0.0, -1.0}));
  EXPECT_FALSE(project(strong_camera(), {1.0, 0.0, 0.0}));
  EXPECT_FALSE(project_undistorted(strong_camera(), {0.0, 0.0, -1.0}));
}

// Outwards from the middle pixels go outwards, until there are none any more: for lenses that turn
// back (barrel, moustache), and none for one that never does.
TEST(Camera, WhatDistortionWouldFoldBackIsNotSeen) {
  const auto camera_with = [](double k1, double k2, double k3) {
    core::PinholeRadtan camera{640, 480, 500.0, 500.0, 320.0, 240.0};
    camera.k1 = k1;
    camera.k2 = k2;
    camera.k3 = k3;
    return camera;
  };
  const auto farthest_seen = [](const core::PinholeRadtan& camera) {
    double last_x = 0.0;
    for (double aside = 0.0; aside < 5.0; aside += 0.01) {
      const auto pixel = project(camera, {aside, 0.0, 1.0});
      if (!pixel) return aside;
      EXPECT_GE(pixel->x(), last_x) << aside;
      last_x = pixel->x();
    }
    return 5.0;
  };
  EXPECT_NEAR(farthest_seen(camera_with(0.05, -0.08, 0.0)), 1.333, 0.02);
  EXPECT_NEAR(farthest_seen(camera_with(-0.3, 0.0, 0.0)), 1.054, 0.02);
  EXPECT_NEAR(farthest_seen(camera_with(-0.4, 0.07, 0.0)), 1.195, 0.02) << "and turns once more";
  EXPECT_NEAR(farthest_seen(camera_with(-0.9, 0.35, -0.03)), 0.748, 0.02) << "twice more";
  EXPECT_EQ(farthest_seen(camera_with(0.0, 0.0, 0.0)), 5.0);
  EXPECT_EQ(farthest_seen(camera_with(0.2, 0.1, 0.1)), 5.0);
  EXPECT_EQ(farthest_seen(strong_camera()), 5.0);
}

TEST(Camera, TheFieldOfViewReachesFromEdgeToEdge) {
  constexpr double kRight_rad = std::numbers::pi / 2.0;
  EXPECT_NEAR(horizontal_field_of_view_rad(core::PinholeRadtan{640, 480, 320, 320, 319.5, 239.5}),
              kRight_rad, 1e-12);
  // a centre at the left edge: all of it lies on the right
  EXPECT_NEAR(horizontal_field_of_view_rad(core::PinholeRadtan{640, 480, 640, 640, -0.5, 239.5}),
              kRight_rad / 2.0, 1e-12);
}

TEST(Camera, BearingsAreUnitVectorsOfTheIdealPixel) {
  const core::Camera camera = strong_camera();
  core::Random random(7);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d pixel(random.uniform(0, 639), random.uniform(0, 479));
    const Eigen::Vector3d direction = bearing(camera, pixel);
    EXPECT_NEAR(direction.norm(), 1.0, 1e-12);
    EXPECT_LT((*project_undistorted(camera, direction) - undistort(camera, pixel)).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace samewhere::geometry
