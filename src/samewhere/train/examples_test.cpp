#include <algorithm>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/train/examples.hpp>
#include <samewhere/train/test_images.hpp>

namespace samewhere::train {
namespace {

TEST(Examples, DependOnSeedAndImageOnly) {
  const ImageSet images = test_images(3);
  const std::vector<int> all = {0, 1, 2};
  const std::vector<int> last = {2};
  const Config config{.contrast = 0.0};
  const ExampleMaker maker(config, images, {.training = all, .validation = {}},
                           scale_of_targets(images.views, all, config.target));
  const Batch batch = maker.batch(all, 11);
  const Batch alone = maker.batch(last, 11);
  const Batch other = maker.batch(last, 12);
  ASSERT_EQ(batch.inputs.size(), 3U * 120 * 160);
  ASSERT_EQ(batch.targets.size(), 3U * 5940);
  EXPECT_TRUE(
      std::equal(alone.inputs.begin(), alone.inputs.end(), batch.inputs.begin() + 2 * 120 * 160));
  EXPECT_NE(alone.inputs, other.inputs);
  EXPECT_EQ(alone.targets, other.targets) << "the target is of the undistorted view";
}

TEST(Examples, EachViewHasAPartnerBehindIt) {
  const ImageSet images = test_images(3);
  const std::vector<int> all = {0, 1, 2};
  const Split split{.training = all, .validation = {}};
  const auto batch_with = [&](double contrast) {
    return ExampleMaker({.contrast = contrast}, images, split,
                        scale_of_targets(images.views, all, Target::kHog))
        .batch(all, 11);
  };
  const Batch alone = batch_with(0.0);
  const Batch paired = batch_with(0.5);
  EXPECT_TRUE(alone.other_places.empty());
  EXPECT_EQ(paired.other_places.size(), 9U);
  ASSERT_EQ(paired.num_examples, 6);
  ASSERT_EQ(paired.inputs.size(), 2 * alone.inputs.size());
  const auto middle = paired.inputs.begin() + static_cast<std::ptrdiff_t>(alone.inputs.size());
  EXPECT_TRUE(std::equal(paired.inputs.begin(), middle, alone.inputs.begin()));
  EXPECT_FALSE(std::equal(middle, paired.inputs.end(), alone.inputs.begin()))
      << "distorted otherwise";
  EXPECT_TRUE(
      std::equal(alone.targets.begin(), alone.targets.end(),
                 paired.targets.begin() + static_cast<std::ptrdiff_t>(alone.targets.size())))
      << "no other frame of the place is known: the view itself";
}

TEST(Examples, StayInTheRangeOfAPicture) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    core::Random random(seed);
    const cv::Mat input = distorted_input(test_picture(static_cast<int>(seed)), Config{}, random);
    EXPECT_EQ(input.size(), cv::Size(160, 120));
    double low = 0.0;
    double high = 0.0;
    cv::minMaxLoc(input, &low, &high);
    EXPECT_GE(low, 0.0);
    EXPECT_LE(high, 1.0);
    EXPECT_GT(high - low, 0.1) << "structure is left";
  }
}

// The left half dark, the right half bright: where the edge lies says how far things moved.
TEST(Examples, OnlyAWarpMovesThings) {
  cv::Mat view(240, 320, CV_8UC1, cv::Scalar(40));
  view.colRange(160, 320).setTo(220);
  const auto edge_column = [&](bool warp, std::uint64_t seed) {
    core::Random random(seed);
    const cv::Mat input = distorted_input(view, Config{.warp = warp}, random);
    cv::Mat blurred;
    cv::GaussianBlur(input, blurred, cv::Size(), 2.0);
    int steepest = 1;  // light that falls otherwise is less steep
    const auto step = [row = blurred.row(60)](int column) {
      return row.at<float>(column) - row.at<float>(column - 1);
    };
    for (int column = 1; column < 160; ++column) {
      if (step(column) > step(steepest)) steepest = column;
    }
    return steepest;
  };
  int farthest = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    EXPECT_NEAR(edge_column(false, seed), 80, 2);
    farthest = std::max(farthest, std::abs(edge_column(true, seed) - 80));
  }
  EXPECT_GT(farthest, 10);
  EXPECT_LE(farthest, 40) << "corners move by a quarter of the side at most";
}

// So that a network which answers nothing but the mean has an error of 1, for either target.
TEST(Examples, ScaledTargetsHaveMeanZeroAndVarianceOne) {
  const ImageSet images = test_images(5);
  const std::vector<int> all = {0, 1, 2, 3, 4};
  for (const Target target : {Target::kHog, Target::kPixels}) {
    const ExampleMaker maker({.target = target}, images, {.training = all, .validation = {}},
                             scale_of_targets(images.views, all, target));
    const std::vector<float> targets = maker.batch(all, 1).targets;
    const auto length = static_cast<std::size_t>(target_length(target));
    double sum_of_first = 0.0;
    double sum_of_squares = 0.0;
    for (std::size_t i = 0; i < targets.size(); i += length) sum_of_first += targets[i];
    for (const float number : targets) sum_of_squares += static_cast<double>(number) * number;
    EXPECT_NEAR(sum_of_first, 0.0, 1e-4);
    EXPECT_NEAR(sum_of_squares / static_cast<double>(targets.size()), 1.0, 1e-4);
  }
}

TEST(Examples, PixelsAreAReducedView) {
  const cv::Mat view(240, 320, CV_8UC1, cv::Scalar(51));
  const std::vector<float> pixels = target_of(view, Target::kPixels);
  ASSERT_EQ(pixels.size(), 60U * 80);
  EXPECT_FLOAT_EQ(pixels[1234], 0.2F);
}

}  // namespace
}  // namespace samewhere::train
