#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/pairs/other_camera.hpp>

namespace samewhere::pairs {
namespace {

cv::Mat disc_at(int x, int y) {
  cv::Mat picture(240, 320, CV_8UC1, cv::Scalar(60));
  cv::circle(picture, {x, y}, 20, cv::Scalar(220), cv::FILLED);
  return picture;
}

TEST(ByAnotherCamera, WhatIsSeenStaysWhereItIs) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    core::Random random(seed);
    const cv::Mat seen = by_another_camera(disc_at(200, 90), random);
    ASSERT_EQ(seen.size(), cv::Size(320, 240)) << "seed " << seed;
    const cv::Mat around =
        seen(cv::Rect(170, 60, 60, 60)) > cv::mean(seen(cv::Rect(170, 60, 60, 60)))[0];
    const cv::Moments moments = cv::moments(around, true);
    EXPECT_NEAR(moments.m10 / moments.m00, 30.0, 1.5) << "seed " << seed;
    EXPECT_NEAR(moments.m01 / moments.m00, 30.0, 1.5) << "seed " << seed;
  }
}

TEST(ByAnotherCamera, TheSeedDecidesAndTheOriginalIsLeftAlone) {
  const cv::Mat picture = disc_at(100, 100);
  const cv::Mat before = picture.clone();
  core::Random first(1);
  core::Random again(1);
  core::Random other(2);
  const cv::Mat seen = by_another_camera(picture, first);
  EXPECT_EQ(cv::norm(seen, by_another_camera(picture, again), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(seen, by_another_camera(picture, other), cv::NORM_INF), 5.0);
  EXPECT_EQ(cv::norm(picture, before, cv::NORM_INF), 0.0);
}

TEST(ByAnotherCamera, APictureOfFloatsIsAMistakeOfOurs) {
  core::Random random(1);
  EXPECT_THROW(by_another_camera(cv::Mat(24, 32, CV_32F, cv::Scalar(0)), random),
               core::ContractError);
}

}  // namespace
}  // namespace samewhere::pairs
