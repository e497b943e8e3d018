#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/train/test_images.hpp>
#include <samewhere/train/validation.hpp>

namespace samewhere::train {
namespace {

// The i-th has a 1 at place i + `shift`; what falls off comes in at the other end.
Codes shifted(std::size_t count, std::size_t shift) {
  Codes codes(count, std::vector<float>(count, 0.0F));
  for (std::size_t i = 0; i < count; ++i) codes[i][(i + shift) % count] = 1.0F;
  return codes;
}

std::vector<int> range(int begin, int count) {
  std::vector<int> indices(static_cast<std::size_t>(count));
  std::iota(indices.begin(), indices.end(), begin);
  return indices;
}

TEST(Recognition, FindsAllByACodeThatIsBlindToTheViewpointAndFewByOneThatIsBlindToAll) {
  const ImageSet images{.sources = {{"walk", 100}}};
  const std::vector<int> views = range(0, 100);
  EXPECT_EQ(share_found(images, views, shifted(100, 0), shifted(100, 0)), 1.0);
  const Codes constant(100, {1.0F, 0.0F});
  EXPECT_EQ(share_found(images, views, constant, constant), 0.05) << "the first and its neighbours";
}

TEST(Recognition, ANeighbourIsAtMostFourAway) {
  const ImageSet images{.sources = {{"walk", 20}}};
  const std::vector<int> views = range(0, 20);
  EXPECT_EQ(share_found(images, views, shifted(20, 0), shifted(20, 4)), 0.8);
  EXPECT_EQ(share_found(images, views, shifted(20, 0), shifted(20, 5)), 0.0);
}

// Three pieces of eight views: the second is far behind the first in the same walk, the third
// begins another walk right behind the second. Each view is taken for the next in the list, so the
// last of each piece is taken for the first of another.
TEST(Recognition, TheNextInTheListIsNoNeighbourAcrossAGapOrInAnotherWalk) {
  const ImageSet images{.sources = {{"first", 100}, {"second", 100}}};
  std::vector<int> views = range(0, 8);
  for (const int view : range(92, 16)) views.push_back(view);
  EXPECT_DOUBLE_EQ(share_found(images, views, shifted(24, 0), shifted(24, 1)), 21.0 / 24.0);
}

TEST(Recognition, ByHogIsBetterThanByTheMeanBrightnessOfFourQuarters) {
  const ImageSet images = test_images(60);
  const Split split{.validation = range(0, 60)};
  const auto quarters = [](const cv::Mat& input) {
    cv::Mat small;
    cv::resize(input, small, {2, 2}, 0.0, 0.0, cv::INTER_AREA);
    return std::vector<float>(small.begin<float>(), small.end<float>());
  };
  const double by_hog = recognition(images, split, test_config(), hog_of_input);
  const double by_quarters = recognition(images, split, test_config(), quarters);
  EXPECT_GT(by_hog, by_quarters);
  EXPECT_GT(by_hog, 2.0 * 9.0 / 60.0) << "twice chance";
  EXPECT_EQ(by_hog, recognition(images, split, test_config(), hog_of_input));
}

}  // namespace
}  // namespace samewhere::train
