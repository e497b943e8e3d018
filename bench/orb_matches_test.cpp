#include "orb_matches.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "test_images.hpp"

namespace samewhere::bench {
namespace {

TEST(OrbMatches, AShiftedPictureMatchesAndNoiseDoesNot) {
  cv::Mat blobs;
  cv::GaussianBlur(grey_noise({420, 340}, 128.0, 120.0, 3), blobs, cv::Size(), 2.0);
  cv::normalize(blobs, blobs, 0, 255, cv::NORM_MINMAX);
  cv::Mat other;
  cv::GaussianBlur(grey_noise({400, 320}, 128.0, 120.0, 4), other, cv::Size(), 2.0);
  cv::normalize(other, other, 0, 255, cv::NORM_MINMAX);
  const OrbFeatures here = extract_orb(blobs(cv::Rect(0, 0, 400, 320)), 500);
  const OrbFeatures shifted = extract_orb(blobs(cv::Rect(20, 20, 400, 320)), 500);
  EXPECT_GT(count_inliers(here, shifted), 100);
  EXPECT_LT(count_inliers(here, extract_orb(other, 500)), 20);
  EXPECT_EQ(count_inliers(here, OrbFeatures()), 0);
}

}  // namespace
}  // namespace samewhere::bench
