#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/train/pair_examples.hpp>
#include <samewhere/train/test_pairs.hpp>

namespace samewhere::train {
namespace {

using verify::kPairSide_px;
using verify::PairPlane;

cv::Mat plane(const cv::Mat& planes, PairPlane which) {
  const int first = static_cast<int>(which) * kPairSide_px;
  return planes.rowRange(first, first + kPairSide_px);
}

cv::Mat distorted(const cv::Mat& planes, std::uint64_t seed, double hidden_pictures) {
  PairConfig config = test_pair_config();
  config.hidden_pictures = hidden_pictures;
  core::Random random(seed);
  return distorted_pair(planes, config, random);
}

TEST(DistortedPair, IsStillAPair) {
  const cv::Mat planes = test_planes(1, false);
  const cv::Mat before = planes.clone();
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const cv::Mat pair = distorted(planes, seed, 0.0);
    ASSERT_EQ(pair.size(), planes.size());
    double least = 0.0;
    double most = 0.0;
    cv::minMaxLoc(pair.rowRange(0, 2 * kPairSide_px), &least, &most);
    EXPECT_TRUE(least >= -1.0 && least < -0.2 && most > 0.2 && most <= 1.0) << "seed " << seed;
    cv::minMaxLoc(pair.rowRange(2 * kPairSide_px, pair.rows), &least, &most);
    EXPECT_TRUE(least >= 0.0 && most > 0.5 && most <= 1.0) << "seed " << seed;
    // a light that only one sees is in no picture
    const cv::Mat unseen = plane(pair, PairPlane::kSeenByBoth) == 0.0F;
    EXPECT_EQ(cv::norm(plane(pair, PairPlane::kQuery), cv::NORM_INF, unseen), 0.0);
  }
  EXPECT_EQ(cv::norm(planes, before, cv::NORM_INF), 0.0);
}

TEST(DistortedPair, PicturesCanBeHiddenAndFeaturesStay) {
  const cv::Mat pair = distorted(test_planes(2, false), 3, 1.0);
  EXPECT_EQ(cv::norm(pair.rowRange(0, 2 * kPairSide_px), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::sum(plane(pair, PairPlane::kOnlyQueryShows))[0], 50.0);
}

// What only one view shows goes with its picture.
TEST(DistortedPair, EitherViewMayBeFirst) {
  cv::Mat planes = cv::Mat::zeros(verify::kNumPairPlanes * kPairSide_px, kPairSide_px, CV_32F);
  plane(planes, PairPlane::kSeenByBoth).setTo(1.0F);
  plane(planes, PairPlane::kQuery).setTo(0.9F);
  plane(planes, PairPlane::kOnlyQueryShows).setTo(1.0F);
  int num_swapped = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const cv::Mat pair = distorted(planes, seed, 0.0);
    const auto sum = [&](PairPlane which) { return cv::sum(plane(pair, which))[0]; };
    const bool is_swapped = sum(PairPlane::kMatch) > sum(PairPlane::kQuery);
    EXPECT_EQ(is_swapped, sum(PairPlane::kOnlyMatchShows) > sum(PairPlane::kOnlyQueryShows));
    num_swapped += is_swapped ? 1 : 0;
  }
  EXPECT_TRUE(num_swapped > 8 && num_swapped < 32) << num_swapped;
}

TEST(PairExampleMaker, BothKindsWeighTheSameAndTheSeedDecides) {
  PairSet set = test_pairs(6);
  for (std::size_t i = 0; i < 8; ++i) set.pairs[i].is_same = i == 0;
  std::vector<int> indices(8);
  std::iota(indices.begin(), indices.end(), 0);
  const PairExampleMaker maker(test_pair_config(), set.pairs, indices);
  const PairBatch batch = maker.distorted(indices, 1);
  ASSERT_EQ(batch.num_examples, 8);
  EXPECT_FLOAT_EQ(batch.weights[0], 4.0F);
  EXPECT_FLOAT_EQ(std::accumulate(batch.weights.begin(), batch.weights.end(), 0.0F), 8.0F);
  EXPECT_EQ(maker.distorted(indices, 1).planes, batch.planes);
  EXPECT_NE(maker.distorted(indices, 2).planes, batch.planes);
  const cv::Mat plain = unpacked(set.pairs[0].planes);
  EXPECT_THAT(maker.plain(std::vector<int>{0}).planes,
              testing::ElementsAreArray(plain.begin<float>(), plain.end<float>()));
}

}  // namespace
}  // namespace samewhere::train
