#include <gtest/gtest.h>

#include <samewhere/track/free_space.hpp>

namespace samewhere::track {
namespace {

const core::PinholeRadtan kWallCamera{.width_px = 640,
                                      .height_px = 480,
                                      .fx_px = 500.0,
                                      .fy_px = 500.0,
                                      .cx_px = 319.5,
                                      .cy_px = 239.5};

// A wall 4 m ahead with a pillar, 10 cells wide, 2 m ahead, and a hole in what is known.
cv::Mat picture() {
  cv::Mat depth_m(480, 640, CV_32F, cv::Scalar(4.0));
  depth_m(cv::Rect(0, 0, 80, 480)).setTo(2.0F);
  depth_m(cv::Rect(400, 200, 80, 80)).setTo(0.0F);
  return depth_m;
}

// What is seen at a pixel, so far along the optical axis.
Eigen::Vector3d point(double x_px, double y_px, double z_m) {
  return {(x_px - kWallCamera.cx_px) / kWallCamera.fx_px * z_m,
          (y_px - kWallCamera.cy_px) / kWallCamera.fy_px * z_m, z_m};
}

TEST(NearestSurface, SeesThroughWhatHasComeSince) {
  const NearestSurface seen(picture(), kWallCamera);
  EXPECT_TRUE(seen.sees_through(point(300.0, 240.0, 2.0)));
  EXPECT_TRUE(seen.sees_through(point(300.0, 240.0, 3.4)));
  EXPECT_FALSE(seen.sees_through(point(300.0, 240.0, 3.9))) << "the wall itself, measured badly";
  EXPECT_FALSE(seen.sees_through(point(300.0, 240.0, 5.0))) << "behind the wall";
  EXPECT_FALSE(seen.sees_through(point(40.0, 240.0, 2.0))) << "the pillar";
}

TEST(NearestSurface, IsNotSureBesideSomethingNearNorWhereItKnowsNothing) {
  const NearestSurface seen(picture(), kWallCamera);
  EXPECT_FALSE(seen.sees_through(point(84.0, 240.0, 2.0))) << "the pillar's edge";
  EXPECT_TRUE(seen.sees_through(point(92.0, 240.0, 2.0)));
  EXPECT_FALSE(seen.sees_through(point(440.0, 240.0, 2.0))) << "unknown";
  EXPECT_FALSE(seen.sees_through(point(2.0, 240.0, 1.0))) << "at the border";
  EXPECT_FALSE(seen.sees_through(point(900.0, 240.0, 1.0))) << "out of the picture";
  EXPECT_FALSE(seen.sees_through({0.0, 0.0, -1.0})) << "behind the camera";
}

TEST(NearestSurface, AFewUnknownPixelsHideNothing) {
  cv::Mat depth_m(480, 640, CV_32F, cv::Scalar(4.0));
  for (int y = 0; y < depth_m.rows; y += 3) depth_m.row(y).colRange(0, 320).setTo(0.0F);
  for (int y = 0; y < depth_m.rows; y += 8) depth_m.row(y).setTo(0.0F);
  const NearestSurface seen(depth_m, kWallCamera);
  EXPECT_TRUE(seen.sees_through(point(500.0, 240.0, 2.0))) << "one row of eight";
  EXPECT_FALSE(seen.sees_through(point(100.0, 240.0, 2.0))) << "more than a quarter";
}

}  // namespace
}  // namespace samewhere::track
