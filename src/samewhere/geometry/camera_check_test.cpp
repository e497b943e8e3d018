#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/geometry/camera_check.hpp>

namespace samewhere::geometry {
namespace {

using testing::HasSubstr;

core::PinholeRadtan camera() {
  return {640, 480, 517.3, 516.5, 318.6, 255.3, 0.2624, -0.9531, -0.0054, 0.0026, 1.1633};
}

template <class Change>
std::string fault_after(Change change) {
  core::PinholeRadtan changed = camera();
  change(changed);
  return fault_of(changed).value_or("none");
}

TEST(CameraCheck, PublishedCalibrationsPass) {
  EXPECT_EQ(fault_of(camera()).value_or("none"), "none");
  // EuRoC, KITTI raw, Azure Kinect (rational), TUM-VI (fisheye of 195 degrees)
  EXPECT_FALSE(fault_of(core::PinholeRadtan{752, 480, 458.654, 457.296, 367.215, 248.375,
                                            -0.28340811, 0.07395907, 0.00019359, 1.76187114e-05}));
  EXPECT_FALSE(
      fault_of(core::PinholeRadtan{1392, 512, 984.2439, 980.8141, 690.0, 233.1966, -0.3728755,
                                   0.2037299, 0.002219027, 0.001383707, -0.07233722}));
  EXPECT_FALSE(
      fault_of(core::PinholeRadtan{2048, 1536, 976.4, 976.1, 1019.7, 785.9, 0.5134, -2.5922,
                                   0.00036, -0.00013, 1.4764, 0.3939, -2.4167, 1.4018}));
  EXPECT_FALSE(
      fault_of(core::KannalaBrandt{512, 512, 190.978477, 190.973307, 254.931706, 256.897442,
                                   0.0034823894, 0.0007150348, -0.0020532361, 0.00020293673}));
}

TEST(CameraCheck, NumbersThatNoLensHasAreNamed) {
  for (const double huge : {1e5, 1e100, 1e200, -1e300}) {
    EXPECT_THAT(fault_after([&](auto& c) { c.k1 = huge; }), HasSubstr("distortion k1 = "));
    EXPECT_THAT(fault_after([&](auto& c) { c.k2 = huge; }), HasSubstr("distortion k2 = "));
    EXPECT_THAT(fault_after([&](auto& c) { c.p1 = huge; }), HasSubstr("distortion p1 = "));
    EXPECT_THAT(fault_after([&](auto& c) { c.p2 = huge; }), HasSubstr("distortion p2 = "));
    EXPECT_THAT(fault_after([&](auto& c) { c.k3 = huge; }), HasSubstr("distortion k3 = "));
    EXPECT_THAT(fault_after([&](auto& c) { c.k6 = huge; }), HasSubstr("distortion k6 = "));
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(fault_after([&](auto& c) { c.k2 = nan; }), HasSubstr("distortion k2 = nan"));
  EXPECT_THAT(fault_after([&](auto& c) { c.fx_px = nan; }), HasSubstr("fx = nan"));
  EXPECT_THAT(fault_after([&](auto& c) { c.fy_px = 1e-300; }), HasSubstr("fy = 1e-300"));
  EXPECT_THAT(fault_after([&](auto& c) { c.fx_px = 1e300; }), HasSubstr("fx = 1e+300"));
  EXPECT_THAT(fault_after([&](auto& c) { c.fx_px = 5000.0; }), HasSubstr("nearly equal"));
  EXPECT_THAT(fault_after([&](auto& c) { c.cy_px = 480.0; }), HasSubstr("lies outside"));
  EXPECT_THAT(fault_after([&](auto& c) { c.width_px = -640; }), HasSubstr("-640 x 480"));
}

// Each number is small enough, and still no pixel of the border has one direction.
TEST(CameraCheck, DistortionThatFoldsThePictureIsNamed) {
  EXPECT_THAT(fault_after([](auto& c) { c.k1 = -3.0; }), HasSubstr("k1 = -3 folds the picture"));
  EXPECT_THAT(fault_after([](auto& c) { c.p1 = 8.0; }), HasSubstr("p1 = 8 folds the picture"));
  EXPECT_THAT(fault_after([](auto& c) { c.k4 = -40.0; }), HasSubstr("k4 = -40 folds the picture"));
  core::KannalaBrandt fisheye{640, 480, 250.0, 250.0, 319.5, 239.5, -0.9};
  EXPECT_THAT(fault_of(fisheye).value_or("none"), HasSubstr("k1 = -0.9 folds the picture"));
}

TEST(CameraCheck, WithoutTheSizeOfItsPicturesTheNumbersAloneAreChecked) {
  EXPECT_EQ(fault_after([](auto& c) { c.width_px = c.height_px = 0; }), "none");
  EXPECT_THAT(fault_after([](auto& c) {
                c.width_px = c.height_px = 0;
                c.fx_px = 1e9;
              }),
              HasSubstr("fx = 1000000000"));
}

}  // namespace
}  // namespace samewhere::geometry
