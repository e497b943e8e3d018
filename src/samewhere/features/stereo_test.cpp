#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/features/orb.hpp>
#include <samewhere/features/stereo.hpp>

namespace samewhere::features {
namespace {

constexpr double kBaseline_m = 0.1;
constexpr double kFocal_px = 500.0;

cv::Mat speckled(std::uint64_t seed) {
  core::Random random(seed);
  cv::Mat image(480, 640, CV_8U);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(random.index(256));
    }
  }
  cv::GaussianBlur(image, image, {}, 3.0);
  cv::normalize(image, image, 0, 255, cv::NORM_MINMAX);
  return image;
}

core::Rig pair_rig() {
  core::Rig rig;
  const core::PinholeRadtan camera{640, 480, kFocal_px, kFocal_px, 320, 240};
  rig.cameras = {camera, camera};
  rig.body_from_camera = {core::Rigid3{}, core::Rigid3{}};
  rig.body_from_camera[1].translation.x() = kBaseline_m;
  return rig;
}

// A wall straight ahead, seen by both cameras of a rig.
core::Frame wall(double disparity_px, const core::Rig& rig = pair_rig()) {
  const cv::Mat left = speckled(1);
  const cv::Matx23d shift(1, 0, -disparity_px, 0, 1, 0);
  cv::Mat right;
  cv::warpAffine(left, right, shift, left.size(), cv::INTER_CUBIC, cv::BORDER_REFLECT_101);
  core::Frame frame;
  frame.rig = std::make_shared<const core::Rig>(rig);
  frame.images = {left, right};
  return frame;
}

TEST(Stereo, AWallIsAsFarAsItsDisparitySays) {
  for (const double disparity_px : {2.3, 12.0, 40.5}) {
    SCOPED_TRACE(disparity_px);
    const View view = extract(wall(disparity_px), {});
    int num_known = 0;
    for (std::size_t i = 0; i < view.features->depth_m.size(); ++i) {
      const float right_x_px = view.features->right_x_px[i];
      EXPECT_EQ(std::isnan(right_x_px), view.features->depth_m[i] == 0.0F);
      if (std::isnan(right_x_px)) continue;
      ++num_known;
      const double level_px = std::pow(1.2, view.features->octave[i]);
      EXPECT_NEAR(view.features->raw_px[i].x() - right_x_px, disparity_px, 0.3 * level_px);
      EXPECT_NEAR(view.features->depth_m[i] * (view.features->raw_px[i].x() - right_x_px),
                  kFocal_px * kBaseline_m, 1e-2);
    }
    EXPECT_GT(num_known, 0.5 * view.features->size());
  }
}

TEST(Stereo, WhatIsNotInTheOtherPictureHasNoDepth) {
  core::Frame frame = wall(10.0);
  frame.images[1] = speckled(2);
  const View view = extract(frame, {});
  const auto num_known = std::count_if(view.features->depth_m.begin(), view.features->depth_m.end(),
                                       [](float depth_m) { return depth_m > 0.0F; });
  EXPECT_LT(num_known, 0.05 * view.features->size());
}

// The second picture is prepared like the first, else what is compared has other levels.
TEST(Stereo, EqualisedPicturesOfUnlikeExposureAgree) {
  core::Frame frame = wall(12.0);
  frame.images[1] = 0.3 * frame.images[1] + 20;
  const View view = extract(frame, {.equalize = true});
  const auto num_right = std::count_if(
      view.features->depth_m.begin(), view.features->depth_m.end(),
      [](float depth_m) { return std::abs(depth_m - kFocal_px * kBaseline_m / 12.0) < 0.1; });
  EXPECT_GT(num_right, 0.5 * view.features->size());
}

TEST(Stereo, APairThatIsNotRectifiedIsRefused) {
  core::Rig turned = pair_rig();
  turned.body_from_camera[1].rotation = Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitY());
  core::Rig raised = pair_rig();
  raised.body_from_camera[1].translation.y() = 0.01;
  core::Rig distorted = pair_rig();
  std::get<core::PinholeRadtan>(distorted.cameras[1]).k1 = 0.1;
  core::Rig swapped = pair_rig();
  swapped.body_from_camera[1].translation.x() = -kBaseline_m;
  for (const auto& rig : {turned, raised, distorted, swapped}) {
    EXPECT_THROW(extract(wall(10.0, rig), {}), core::ContractError);
  }
}

TEST(Stereo, TheBaselineIsTheRigsOrTheConfigs) {
  EXPECT_DOUBLE_EQ(baseline_m(pair_rig(), {}), kBaseline_m);
  EXPECT_DOUBLE_EQ(baseline_m(core::Rig{}, {.virtual_baseline_m = 0.2}), 0.2);
}

}  // namespace
}  // namespace samewhere::features
