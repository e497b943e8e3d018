#include "shared_surface.hpp"

#include <gtest/gtest.h>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/twin/front/camera.hpp>

namespace samewhere::bench {
namespace {

constexpr double kWall_m = 2.0;
const core::Camera kCamera = twin::kTwinCamera;

// Of a wall, perpendicular to the optical axis: constant depth.
SurfaceView before_the_wall(int frame, double aside_m, double depth_m = kWall_m) {
  const auto& camera = std::get<core::PinholeRadtan>(kCamera);
  SurfaceView view = surface_view(
      frame, cv::Mat(camera.height_px, camera.width_px, CV_32F, cv::Scalar(depth_m)), kCamera);
  view.seen.world_from_camera.translation.x() = aside_m;
  return view;
}

// Of a sphere, from its centre: constant range for every rotation.
SurfaceView in_the_sphere(int frame, double turned_rad) {
  const auto& camera = std::get<core::PinholeRadtan>(kCamera);
  cv::Mat depth_m(camera.height_px, camera.width_px, CV_32F);
  for (int y = 0; y < depth_m.rows; ++y)
    for (int x = 0; x < depth_m.cols; ++x)
      depth_m.at<float>(y, x) = static_cast<float>(
          kWall_m * geometry::bearing(kCamera, Eigen::Vector2d(x, y)).normalized().z());
  SurfaceView view = surface_view(frame, depth_m, kCamera);
  view.seen.world_from_camera.rotation = core::exp_so3(turned_rad * Eigen::Vector3d::UnitY());
  return view;
}

// About: the lens shows a little more.
double width_m() {
  const auto& camera = std::get<core::PinholeRadtan>(kCamera);
  return kWall_m * camera.width_px / camera.fx_px;
}

SharedSurface shared(const SurfaceView& a, const SurfaceView& b) {
  return shared_surface(a, b, kCamera, &SurfaceView::fine);
}

TEST(SharedSurface, ATranslationAsideSharesTheRestOfTheWall) {
  EXPECT_NEAR(shared(before_the_wall(0, 0.0), before_the_wall(1, 0.0)).share, 1.0, 0.01);
  EXPECT_NEAR(shared(before_the_wall(0, 0.0), before_the_wall(1, 0.4 * width_m())).share, 0.6,
              0.02);
  EXPECT_EQ(shared(before_the_wall(0, 0.0), before_the_wall(1, 1.5 * width_m())).share, 0.0);
}

TEST(SharedSurface, WhatIsNearerIsAnotherSurface) {
  EXPECT_EQ(shared(before_the_wall(0, 0.0), before_the_wall(1, 0.0, 1.7)).share, 0.0);
  EXPECT_GT(shared(before_the_wall(0, 0.0), before_the_wall(1, 0.0, 1.9)).share, 0.9);
}

TEST(SharedSurface, AtTheLimitOfTheTruthTheProbabilityIsBetween0And1) {
  const SurfaceView query = before_the_wall(0, 0.0);
  EXPECT_GT(shared(query, before_the_wall(1, 0.3 * width_m())).likeliness, 0.99);
  EXPECT_NEAR(shared(query, before_the_wall(1, 0.7 * width_m())).likeliness, 0.25, 0.1);
  EXPECT_LT(shared(query, before_the_wall(1, 0.9 * width_m())).likeliness, 0.01);
}

TEST(SharedSurface, ADifferentViewingDirectionIsADifferentPlaceDespiteSharedSurface) {
  const SurfaceView query = in_the_sphere(0, 0.0);
  const SharedSurface little = shared(query, in_the_sphere(1, 0.35));
  const SharedSurface too_much = shared(query, in_the_sphere(1, 0.9));
  EXPECT_GT(little.share, 0.5);
  EXPECT_GT(little.likeliness, 0.99);
  EXPECT_LT(too_much.likeliness, 0.01) << "more than 45 degrees";
  EXPECT_EQ(shared(query, in_the_sphere(1, 1.6)).share, 0.0);
}

TEST(SharedSurface, TooFewPointsShareNothing) {
  cv::Mat depth_m = cv::Mat::zeros(480, 640, CV_32F);
  depth_m(cv::Rect(320, 240, 20, 20)) = static_cast<float>(kWall_m);
  const SurfaceView view = surface_view(0, depth_m, kCamera);
  EXPECT_GT(view.fine.size(), 0U);
  EXPECT_EQ(shared(view, view).share, 0.0);
}

TEST(PlacesBySurface, TheMostProbableViewBeforeTheWindowIsTheMatch) {
  std::vector<SurfaceView> views;
  for (int i = 0; i < 6; ++i) views.push_back(before_the_wall(i, 0.35 * width_m() * i));
  views.push_back(before_the_wall(6, 0.4 * width_m()));
  views.push_back(before_the_wall(7, 5.0 * width_m()));
  const auto matches = places_by_surface(views, kCamera, 4);
  ASSERT_EQ(matches.size(), 1U) << "one has nothing outside the window, one shows nothing known";
  EXPECT_EQ(matches[0].query, 6);
  EXPECT_EQ(matches[0].match, 1);
  EXPECT_NEAR(matches[0].score, 0.95, 0.02);
}

}  // namespace
}  // namespace samewhere::bench
