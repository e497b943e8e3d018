#include <cstdint>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/histogram.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/features/orb.hpp>
#include <samewhere/features/preprocess.hpp>

namespace samewhere::features {
namespace {

constexpr Config kAsPublished{.denoise = true, .equalize = true};

double max_difference(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF); }

cv::Mat with_noise(const cv::Mat& image, double noise_levels, core::Random& random) {
  cv::Mat noisy = image.clone();
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      noisy.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(
          image.at<std::uint8_t>(y, x) + noise_levels * random.gaussian());
    }
  }
  return noisy;
}

// Rectangles in every level from black to white.
cv::Mat papered_wall(core::Random& random) {
  cv::Mat image(480, 640, CV_8UC1, cv::Scalar(128));
  for (int i = 0; i < 400; ++i) {
    const cv::Rect paper(static_cast<int>(random.index(620)), static_cast<int>(random.index(460)),
                         8 + static_cast<int>(random.index(40)),
                         8 + static_cast<int>(random.index(40)));
    cv::rectangle(image, paper, cv::Scalar(random.uniform(0, 255)), cv::FILLED);
  }
  return image;
}

int num_features(const cv::Mat& image, const Config& config) {
  core::Frame frame;
  frame.rig = std::make_shared<const core::Rig>();
  frame.images = {image};
  return extract(frame, config).features->size();
}

TEST(PreprocessForCorners, ByDefaultIsThePictureItself) {
  const cv::Mat grey(48, 64, CV_8UC1, cv::Scalar(77));
  EXPECT_EQ(preprocess(grey, {}).data, grey.data);
  const cv::Mat colour(48, 64, CV_8UC3, cv::Scalar(90, 90, 90));
  EXPECT_EQ(max_difference(preprocess(colour, {}), cv::Mat(48, 64, CV_8UC1, cv::Scalar(90))), 0.0);
}

// A speck is taken out while it is one of a pixel. Equalised first, the surface around it would be
// darker than white for good.
TEST(PreprocessForCorners, TakesNoiseOutBeforeItSpreadsTheLevels) {
  cv::Mat image(48, 64, CV_8UC1, cv::Scalar(100));
  for (int i = 0; i < 40; i += 4) image.at<std::uint8_t>(i, i) = 103;
  EXPECT_EQ(cv::countNonZero(preprocess(image, kAsPublished) != 255), 0);
  cv::Mat in_other_order;
  cv::medianBlur(core::equalize_histogram(image), in_other_order, 3);
  EXPECT_GT(max_difference(preprocess(image, kAsPublished), in_other_order), 0.0)
      << "the order cannot be told on this picture";
}

TEST(PreprocessForCorners, EachStepIsASettingOfItsOwn) {
  core::Random random(3);
  const cv::Mat image = with_noise(papered_wall(random), 5.0, random);
  cv::Mat quiet;
  cv::medianBlur(image, quiet, 3);
  EXPECT_EQ(max_difference(preprocess(image, {.denoise = true}), quiet), 0.0);
  EXPECT_EQ(max_difference(preprocess(image, {.equalize = true}), core::equalize_histogram(image)),
            0.0);
  EXPECT_EQ(max_difference(preprocess(image, kAsPublished), core::equalize_histogram(quiet)), 0.0);
}

TEST(PreprocessForCorners, LeavesThePictureOfTheFrameAlone) {
  core::Random random(1);
  const cv::Mat image = with_noise(papered_wall(random), 5.0, random);
  const cv::Mat before = image.clone();
  preprocess(image, kAsPublished);
  EXPECT_EQ(max_difference(image, before), 0.0);
}

TEST(PreprocessForCorners, FindsInTheDarkWhatThereIsInTheLight) {
  core::Random random(2);
  const cv::Mat bright = papered_wall(random);
  const cv::Mat dark = bright / 32 + 8;
  const Config config{.num_features = 2000};
  const Config equalizing{.equalize = true, .num_features = 2000};
  EXPECT_LT(num_features(dark, config), 0.1 * num_features(bright, config));
  EXPECT_GT(num_features(dark, equalizing), 0.5 * num_features(bright, equalizing));
}

TEST(PreprocessForCorners, NoiseOfAnEvenWallIsNoCorner) {
  core::Random random(4);
  const cv::Mat wall = with_noise(cv::Mat(480, 640, CV_8UC1, cv::Scalar(128)), 6.0, random);
  EXPECT_GT(num_features(wall, {}), 500);
  EXPECT_LT(num_features(wall, {.denoise = true}), 0.5 * num_features(wall, {}));
}

}  // namespace
}  // namespace samewhere::features
