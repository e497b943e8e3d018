#include "picture_statistics.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "test_images.hpp"
#include <samewhere/core/errors.hpp>

namespace samewhere::bench {
namespace {

TEST(PictureStatistics, NoiseIsFoundBesideAnEdge) {
  for (const double deviation : {2.0, 5.0}) {
    cv::Mat image = grey_noise({320, 240}, 90.0, deviation, 1);
    image.colRange(100, 320) += 100;
    // the tenth of the blocks that answers least lies a little below the mean
    EXPECT_NEAR(noise_level(image), deviation, 0.12 * deviation);
  }
  EXPECT_EQ(noise_level(cv::Mat(240, 320, CV_8U, cv::Scalar(255))), 0.0);
}

TEST(PictureStatistics, WhiteNoiseHasNoSlopeAndBlurHasMore) {
  const cv::Mat noise = grey_noise({320, 240}, 128.0, 30.0, 2);
  EXPECT_NEAR(spectrum_slope(noise, 1.0 / 64.0, 1.0 / 3.0), 0.0, 0.1);
  cv::Mat blurred;
  cv::GaussianBlur(noise, blurred, cv::Size(), 1.5);
  EXPECT_GT(spectrum_slope(blurred, 1.0 / 8.0, 1.0 / 3.0), 2.0);
  EXPECT_EQ(spectrum_slope(cv::Mat(240, 320, CV_8U, cv::Scalar(9)), 1.0 / 8.0, 1.0 / 3.0), 0.0);
}

TEST(PictureStatistics, CornersInOneCornerFillOneCell) {
  cv::Mat image(480, 640, CV_8U, cv::Scalar(60));
  cv::rectangle(image, {10, 10}, {25, 25}, cv::Scalar(200), cv::FILLED);
  cv::GaussianBlur(image, image, cv::Size(), 0.8);  // equal neighbours suppress each other
  const PictureStatistics statistics = picture_statistics(image);
  EXPECT_GE(statistics.num_fast_corners, 4.0);
  EXPECT_DOUBLE_EQ(statistics.fast_spread_ratio, 1.0 / (16 * 12));
  EXPECT_GT(statistics.flat_ratio, 0.99);
  EXPECT_THROW(picture_statistics(cv::Mat(63, 640, CV_8U, cv::Scalar(0))), core::ContractError);
}

}  // namespace
}  // namespace samewhere::bench
