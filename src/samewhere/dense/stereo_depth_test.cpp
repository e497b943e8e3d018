#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/dense/stereo_depth.hpp>

namespace samewhere::dense {
namespace {

constexpr double kBaseline_m = 0.12;
constexpr int kDisparity_px = 15;

core::Rig rectified_rig() {
  const core::PinholeRadtan camera{.width_px = 320,
                                   .height_px = 240,
                                   .fx_px = 250.0,
                                   .fy_px = 250.0,
                                   .cx_px = 160.0,
                                   .cy_px = 120.0};
  return {{camera, camera}, {{}, {Eigen::Quaterniond::Identity(), {kBaseline_m, 0.0, 0.0}}}, {}};
}

// A wall of grains as both cameras see it at 250 * 0.12 / 15 = 2 m.
std::pair<cv::Mat, cv::Mat> wall(std::uint64_t seed) {
  core::Random random(seed);
  cv::Mat grains(240, 320 + kDisparity_px, CV_8U);
  for (auto& pixel : cv::Mat_<std::uint8_t>(grains)) {
    pixel = static_cast<std::uint8_t>(random.index(256));
  }
  return {grains.colRange(0, 320).clone(),
          grains.colRange(kDisparity_px, 320 + kDisparity_px).clone()};
}

TEST(StereoDepth, AWallIsAsFarAsItsParallaxSays) {
  const auto [left, right] = wall(6);
  const cv::Mat depth_m = stereo_depth_m(rectified_rig(), left, right, {});
  const int num_known = cv::countNonZero(depth_m);
  EXPECT_GT(num_known, 320 * 240 / 2);
  const int num_right = cv::countNonZero(cv::abs(depth_m - 2.0) < 0.03);  // a quarter of a pixel
  EXPECT_GT(num_right, 0.999 * num_known);
}

TEST(StereoDepth, BlackPicturesHaveNone) {
  const cv::Mat black(240, 320, CV_8UC3, cv::Scalar::all(0));
  const cv::Mat depth_m = stereo_depth_m(rectified_rig(), black, black, {});
  EXPECT_EQ(cv::countNonZero(depth_m), 0);
}

TEST(StereoDepth, APairThatIsNotRectifiedIsRefusedWithTheReason) {
  core::Rig rig = rectified_rig();
  std::get<core::PinholeRadtan>(rig.cameras[1]).cx_px += 5.0;
  const auto [left, right] = wall(8);
  try {
    stereo_depth_m(rig, left, right, {});
    FAIL() << "a pair of different cameras passed";
  } catch (const core::InputError& error) {
    EXPECT_STREQ(error.what(),
                 "expected a rectified pair of pictures: the cameras differ in size, focal length "
                 "or centre");
  }
}

}  // namespace
}  // namespace samewhere::dense
