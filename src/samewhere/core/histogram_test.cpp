#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/histogram.hpp>
#include <samewhere/core/random.hpp>

namespace samewhere::core {
namespace {

constexpr int kNumSeeds = 50;

// Grey levels around a random level with a random spread, so that some images use a few levels and
// some nearly all.
cv::Mat random_image(Random& random, int rows, int columns) {
  cv::Mat image(rows, columns, CV_8UC1);
  const double level = random.uniform(0.0, 255.0);
  const double spread = random.uniform(0.0, 80.0);
  for (int i = 0; i < rows * columns; ++i) {
    image.data[i] = cv::saturate_cast<std::uint8_t>(level + spread * random.gaussian());
  }
  return image;
}

double max_difference(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF); }

TEST(EqualizeHistogram, FollowsTheEquationsOnAHandMadeImage) {
  // S_k: 1/4 up to level 10, 3/4 up to level 20, 1 at level 200
  const cv::Mat image = (cv::Mat_<std::uint8_t>(1, 4) << 10, 20, 20, 200);
  const cv::Mat expected = (cv::Mat_<std::uint8_t>(1, 4) << 64, 191, 191, 255);
  EXPECT_EQ(max_difference(equalize_histogram(image), expected), 0.0);
}

TEST(EqualizeHistogram, KeepsTheOrderOfLevelsAndReachesWhite) {
  for (int seed = 0; seed < kNumSeeds; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const cv::Mat image = random_image(random, 20, 30);
    const cv::Mat equalized = equalize_histogram(image);
    SCOPED_TRACE("seed " + std::to_string(seed));
    EXPECT_EQ(*std::max_element(equalized.datastart, equalized.dataend), 255);
    for (int i = 1; i < 600; ++i) {
      if (image.data[i - 1] <= image.data[i]) {
        EXPECT_LE(equalized.data[i - 1], equalized.data[i]);
      }
    }
  }
}

// OpenCV subtracts the darkest level's own pixels: 255 (S_k - S_0) / (1 - S_0). Ours is therefore
// never darker, and brighter by 255 S_0 at most.
TEST(EqualizeHistogram, DiffersFromOpenCvOnlyByTheShareOfTheDarkestLevel) {
  for (int seed = 0; seed < kNumSeeds; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const cv::Mat image = random_image(random, 40, 30);
    const int darkest = *std::min_element(image.datastart, image.dataend);
    if (darkest == *std::max_element(image.datastart, image.dataend)) continue;
    const auto share = cumulative_histogram(image);
    const double darkest_share = share[static_cast<std::size_t>(darkest)];
    cv::Mat theirs;
    cv::equalizeHist(image, theirs);
    const cv::Mat ours = equalize_histogram(image);
    SCOPED_TRACE("seed " + std::to_string(seed));
    for (int i = 0; i < 1200; ++i) {
      const double stretched = 255.0 * (share[image.data[i]] - darkest_share) / (1 - darkest_share);
      EXPECT_NEAR(theirs.data[i], stretched, 0.501);  // OpenCV computes in float
      EXPECT_GE(ours.data[i], theirs.data[i]);
      EXPECT_LE(ours.data[i], theirs.data[i] + 255.0 * darkest_share + 1.0);
    }
  }
}

TEST(EqualizeHistogram, OfAnImageThatIsEvenAlreadyChangesNothingMuch) {
  cv::Mat ramp(1, 256, CV_8UC1);
  for (int k = 0; k < 256; ++k) ramp.at<std::uint8_t>(k) = static_cast<std::uint8_t>(k);
  EXPECT_LE(max_difference(equalize_histogram(ramp), ramp), 1.0);
}

TEST(EqualizeHistogram, IgnoresAnyChangeOfLightThatKeepsTheOrder) {
  Random random(5);
  const cv::Mat image = random_image(random, 30, 30) / 2;
  const cv::Mat brighter = image + 100;
  EXPECT_EQ(max_difference(equalize_histogram(image), equalize_histogram(brighter)), 0.0);
}

TEST(EqualizeHistogram, RefusesWhatIsNoGreyImage) {
  EXPECT_THROW(equalize_histogram(cv::Mat(4, 4, CV_8UC3, cv::Scalar(0))), ContractError);
  EXPECT_THROW(cumulative_histogram(cv::Mat()), ContractError);
}

}  // namespace
}  // namespace samewhere::core
