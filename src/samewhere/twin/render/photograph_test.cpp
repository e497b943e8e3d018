#include <cmath>
#include <cstring>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <samewhere/twin/render/photograph.hpp>

namespace samewhere::twin {
namespace {

cv::Mat flat(float radiance) { return {120, 160, CV_32FC3, cv::Scalar::all(radiance)}; }

// Of the green levels in the middle of the picture.
struct Levels {
  double mean = 0.0;
  double deviation = 0.0;
};

Levels middle_levels(const cv::Mat& picture) {
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(picture(cv::Rect(60, 40, 40, 40)), mean, deviation);
  return {mean[1], deviation[1]};
}

TEST(Photograph, AGreyWallIsGreyAndItsNoiseGrowsWithTheGain) {
  double last_deviation = 0.0;
  for (const float gain : {1.0F, 4.0F, 16.0F}) {
    const Exposure exposure{.duration_s = 0.01F, .gain = gain};
    const float radiance = 0.2F / exposure.signal_per_radiance();
    const Levels levels = middle_levels(photograph(flat(radiance), exposure, 7));
    // sRGB of a signal of 0.2, less the black and with the contrast of the tone curve
    EXPECT_NEAR(levels.mean, 118.7, 2.5);
    EXPECT_GT(levels.deviation, 1.6 * last_deviation);
    last_deviation = levels.deviation;
  }
  EXPECT_LT(last_deviation, 20.0);
}

TEST(Photograph, DarknessIsNearlyBlackAndLampsAreWhite) {
  const Exposure exposure;
  EXPECT_LT(middle_levels(photograph(flat(0.0F), exposure, 7)).mean, 3.0);
  EXPECT_GT(middle_levels(photograph(flat(5.0F), exposure, 7)).mean, 250.0);
}

TEST(Photograph, AShadowIsBlackAndAGreyWallIsNot) {
  const Exposure exposure;
  const auto level_of = [&](float signal) {
    const float radiance = signal / exposure.signal_per_radiance();
    return middle_levels(photograph(flat(radiance), exposure, 7)).mean;
  };
  EXPECT_LT(level_of(0.005F), 3.0);
  EXPECT_GT(level_of(0.05F), 30.0);
}

TEST(Photograph, ColoursAreStrongerAndGreyStaysGrey) {
  cv::Mat reddish(120, 160, CV_32FC3, cv::Scalar(0.08, 0.1, 0.14));
  const auto spread = [](const cv::Mat& radiance) {
    const cv::Vec3b pixel = photograph(radiance, {}, 7).at<cv::Vec3b>(60, 80);
    return static_cast<int>(pixel[2]) - static_cast<int>(pixel[0]);
  };
  // the plain sRGB levels are 30 apart
  EXPECT_GT(spread(reddish), 34);
  EXPECT_LT(std::abs(spread(flat(0.1F))), 8);
}

TEST(Photograph, CornersAreDarkerThanTheMiddle) {
  const cv::Mat picture = photograph(flat(0.1F), {}, 7);
  const cv::Scalar corner = cv::mean(picture(cv::Rect(0, 0, 12, 12)));
  EXPECT_LT(corner[1], 0.95 * middle_levels(picture).mean);
  EXPECT_GT(corner[1], 0.75 * middle_levels(picture).mean);
}

TEST(Photograph, TheLensSpreadsABrightPointAndKeepsItsLight) {
  cv::Mat point = flat(0.0F);
  point.at<cv::Vec3f>(60, 80) = {0.6F, 0.6F, 0.6F};
  const cv::Mat picture = photograph(point, {}, 7);
  EXPECT_GT(picture.at<cv::Vec3b>(60, 81)[1], 20);
  EXPECT_GT(picture.at<cv::Vec3b>(61, 80)[1], 20);
  EXPECT_LT(picture.at<cv::Vec3b>(60, 83)[1], 10);
}

TEST(Photograph, NoiseFollowsFromTheSeed) {
  const cv::Mat a = photograph(flat(0.1F), {}, 7);
  const cv::Mat b = photograph(flat(0.1F), {}, 7);
  const cv::Mat c = photograph(flat(0.1F), {}, 8);
  EXPECT_EQ(std::memcmp(a.data, b.data, a.total() * a.elemSize()), 0);
  EXPECT_NE(std::memcmp(a.data, c.data, a.total() * a.elemSize()), 0);
}

TEST(Photograph, LightBelowZeroIsBlackAndNoAccident) {
  const cv::Mat picture =
      photograph(cv::Mat(8, 8, CV_32FC3, cv::Scalar::all(-0.5)), {.duration_s = 0.01F}, 1);
  double brightest = 0.0;
  cv::minMaxLoc(picture.reshape(1), nullptr, &brightest);
  EXPECT_LT(brightest, 5.0);
}

}  // namespace
}  // namespace samewhere::twin
