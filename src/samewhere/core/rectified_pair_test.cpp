#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/rectified_pair.hpp>

namespace samewhere::core {
namespace {

using testing::HasSubstr;

Rig straight_rig() {
  const PinholeRadtan camera{.width_px = 640,
                             .height_px = 480,
                             .fx_px = 458.0,
                             .fy_px = 457.0,
                             .cx_px = 322.0,
                             .cy_px = 245.0};
  const Rigid3 body_from_left{exp_so3({0.1, -0.2, 1.5}), {0.02, -0.06, 0.01}};
  const Rigid3 left_from_right{Eigen::Quaterniond::Identity(), {0.11, 0.0, 0.0}};
  return {.cameras = {camera, camera},
          .body_from_camera = {body_from_left, body_from_left * left_from_right}};
}

using Change = std::function<void(PinholeRadtan& right, Rigid3& left_from_right)>;

Result<double, std::string> baseline_after(const Change& change) {
  Rig rig = straight_rig();
  Rigid3 left_from_right = inverse(rig.body_from_camera[0]) * rig.body_from_camera[1];
  change(std::get<PinholeRadtan>(rig.cameras[1]), left_from_right);
  rig.body_from_camera[1] = rig.body_from_camera[0] * left_from_right;
  return rectified_baseline_m(rig);
}

std::string refusal_after(const Change& change) {
  const auto baseline_m = baseline_after(change);
  return baseline_m ? "none" : baseline_m.error();
}

TEST(RectifiedPair, SaysHowFarApartItsCamerasAre) {
  const auto baseline_m = rectified_baseline_m(straight_rig());
  ASSERT_TRUE(baseline_m) << baseline_m.error();
  EXPECT_NEAR(*baseline_m, 0.11, 1e-12);
  EXPECT_TRUE(is_rectified_pair(straight_rig()));
}

TEST(RectifiedPair, WhatAFileRoundsIsForgiven) {
  EXPECT_TRUE(baseline_after([](auto& right, auto&) { right.fx_px += 0.005; }));
  EXPECT_TRUE(baseline_after([](auto& right, auto&) { right.cy_px -= 0.005; }));
  EXPECT_TRUE(baseline_after([](auto&, auto& placed) { placed.translation.z() = 1e-5; }));
  EXPECT_TRUE(baseline_after([](auto&, auto& placed) { placed.rotation = exp_so3({5e-5, 0, 0}); }));
}

TEST(RectifiedPair, CamerasThatDifferAreNone) {
  EXPECT_EQ(refusal_after([](auto& right, auto&) { right.k1 = 0.01; }), "the lenses distort");
  EXPECT_EQ(refusal_after([](auto& right, auto&) { right.p2 = 0.01; }), "the lenses distort");
  const auto differ = HasSubstr("differ in size, focal length or centre");
  EXPECT_THAT(refusal_after([](auto& right, auto&) { right.width_px = 320; }), differ);
  EXPECT_THAT(refusal_after([](auto& right, auto&) { right.fx_px += 0.02; }), differ);
  EXPECT_THAT(refusal_after([](auto& right, auto&) { right.fy_px += 0.02; }), differ);
  EXPECT_THAT(refusal_after([](auto& right, auto&) { right.cx_px += 5.0; }), differ);
  EXPECT_THAT(refusal_after([](auto& right, auto&) { right.cy_px -= 0.02; }), differ);
}

TEST(RectifiedPair, CamerasThatAreNotSideBySideAreNone) {
  const auto misplaced = HasSubstr("not to the right alone");
  EXPECT_THAT(refusal_after([](auto&, auto& placed) {
                placed.rotation = exp_so3({0, 2e-4, 0});
              }),
              HasSubstr("turned by 0.00020 rad"));
  EXPECT_THAT(refusal_after([](auto&, auto& placed) { placed.translation.y() = 0.01; }), misplaced);
  EXPECT_THAT(refusal_after([](auto&, auto& placed) { placed.translation.z() = -0.01; }),
              misplaced);
  EXPECT_THAT(refusal_after([](auto&, auto& placed) { placed.translation.x() = -0.11; }),
              HasSubstr("lies at (-0.1100, "));
  EXPECT_THAT(refusal_after([](auto&, auto& placed) { placed.translation.setZero(); }), misplaced);
}

TEST(RectifiedPair, OneCameraIsNone) {
  Rig alone = straight_rig();
  alone.cameras.pop_back();
  EXPECT_EQ(rectified_baseline_m(alone).error(), "there is no second camera");
  EXPECT_FALSE(is_rectified_pair(Rig{}));
}

}  // namespace
}  // namespace samewhere::core
