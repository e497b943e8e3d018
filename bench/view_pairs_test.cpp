#include "view_pairs.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace samewhere::bench {
namespace {

// A wall 2 m in front of the camera at x = `right_m`, looking straight at it.
ViewGeometry wall_view(double right_m) {
  core::Rig rig;
  rig.cameras.emplace_back(core::PinholeRadtan{
      .width_px = 320, .height_px = 240, .fx_px = 200, .fy_px = 200, .cx_px = 160, .cy_px = 120});
  rig.body_from_camera.emplace_back();
  core::Frame frame;
  frame.rig = std::make_shared<const core::Rig>(rig);
  frame.depth_m = cv::Mat(240, 320, CV_32F, cv::Scalar(2.0F));
  return view_geometry(
      frame, {.rotation = Eigen::Quaterniond::Identity(), .translation = {right_m, 0.0, 0.0}});
}

TEST(ViewPairs, HalfAPictureAsideOverlapsByHalf) {
  // the picture is 3.2 m wide on the wall
  EXPECT_NEAR(shared_view(wall_view(0.0), wall_view(1.6)).overlap, 0.5, 0.03);
  EXPECT_DOUBLE_EQ(shared_view(wall_view(0.0), wall_view(0.0)).overlap, 1.0);
  EXPECT_DOUBLE_EQ(shared_view(wall_view(0.0), wall_view(4.0)).overlap, 0.0);
}

TEST(ViewPairs, ParallaxIsTheAngleBetweenTheDirectionsThatASurfaceIsSeenFrom) {
  // 0.4 m aside at 2 m: 11.4 degrees for what lies between, less towards the sides
  const double parallax_deg = shared_view(wall_view(0.0), wall_view(0.4)).parallax_deg;
  EXPECT_GT(parallax_deg, 9.0);
  EXPECT_LT(parallax_deg, 11.5);
  EXPECT_NEAR(shared_view(wall_view(0.0), wall_view(0.0)).parallax_deg, 0.0, 1e-6);
}

TEST(ViewPairs, ABaselineRunsAsideOrAlongTheViewWhicheverWayRound) {
  const ViewGeometry here = wall_view(0.0);
  const ViewGeometry aside = wall_view(0.3);
  ViewGeometry ahead = here;
  ahead.world_from_camera.translation = {0.1, 0.0, 0.3};
  EXPECT_TRUE(goes(Way::kSideways, here, aside) && goes(Way::kSideways, aside, here));
  EXPECT_TRUE(goes(Way::kForward, here, ahead) && goes(Way::kForward, ahead, here));
  EXPECT_FALSE(goes(Way::kForward, here, aside) || goes(Way::kSideways, here, ahead));
  EXPECT_TRUE(goes(Way::kAny, here, aside) && goes(Way::kAny, here, ahead));
}

TEST(ViewPairs, PairsFallIntoTheirClassAndAreDrawnAlike) {
  EXPECT_EQ(pair_class(wall_view(0.0), wall_view(0.3)), 10);  // 0.15 of the depth, no angle
  EXPECT_EQ(pair_class(wall_view(0.0), wall_view(2.0)), -1);
  std::vector<ViewGeometry> views;
  for (int i = 0; i < 12; ++i) views.push_back(wall_view(0.09 * i));
  const auto pairs = draw_pairs(views, Way::kAny, 5);
  EXPECT_EQ(pairs[0].size(), 5U);
  for (const ViewPair& pair : pairs[10]) {
    const int num_steps = pair.second - pair.first;
    EXPECT_TRUE(num_steps >= 3 && num_steps <= 4) << num_steps;
  }
  const auto again = draw_pairs(views, Way::kAny, 5);
  EXPECT_EQ(pairs[5].front().first, again[5].front().first);
  EXPECT_TRUE(draw_pairs(views, Way::kForward, 5)[10].empty());
}

}  // namespace
}  // namespace samewhere::bench
