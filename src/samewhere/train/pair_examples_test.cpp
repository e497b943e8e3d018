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
  EXPECT_EQ(cv::norm(plane(pair, PairPlane::kAlike), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::sum(plane(pair, PairPlane::kOnlyQueryShows))[0], 50.0);
}

// Of dots everywhere, the same cells are gone from all three planes.
TEST(DistortedPair, CellsWithoutFeaturesAreWithoutThemInAllPlanes) {
  cv::Mat planes = cv::Mat::ones(verify::kNumPairPlanes * kPairSide_px, kPairSide_px, CV_32F);
  PairConfig config = test_pair_config();
  const auto num_empty = [&](double hidden_features) {
    config.hidden_features = hidden_features;
    int num = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      core::Random random(seed);
      const cv::Mat pair = distorted_pair(planes, config, random);
      num += cv::countNonZero(plane(pair, PairPlane::kAgree) +
                                  plane(pair, PairPlane::kOnlyQueryShows) +
                                  plane(pair, PairPlane::kOnlyMatchShows) ==
                              0.0F);
    }
    return num;
  };
  EXPECT_GT(num_empty(0.9), num_empty(0.0) + 10 * kPairSide_px * kPairSide_px / 4);
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

TEST(PairExampleMaker, TheSeedDecides) {
  const PairSet set = test_pairs(4);
  const std::vector<int> indices = {0, 3, 5};
  const PairExampleMaker maker(test_pair_config(), set);
  const PairBatch batch = maker.distorted(indices, 1);
  EXPECT_EQ(batch.num_examples, 3);
  EXPECT_THAT(batch.is_same, testing::ElementsAre(1.0F, 0.0F, 0.0F));
  EXPECT_EQ(maker.distorted(indices, 1).planes, batch.planes);
  EXPECT_NE(maker.distorted(indices, 2).planes, batch.planes);
  const cv::Mat plain = unpacked(set.pairs[0].planes);
  EXPECT_THAT(maker.plain(std::vector<int>{0}).planes,
              testing::ElementsAreArray(plain.begin<float>(), plain.end<float>()));
}

// Of two sources, one nearly all of one place, one of two: neither tells the kind.
TEST(PairWeights, BothKindsWeighTheSameWithinEachSourceToo) {
  PairSet set;
  set.sources = {{"a", 90, 30, false}, {"b", 30, 150, false}, {"c", 1, 3, true}};
  for (const PairSource& source : set.sources) {
    for (int i = 0; i < source.num_same + source.num_wrong; ++i)
      set.pairs.push_back({{}, i < source.num_same});
  }
  const std::vector<float> weights = weights_of(set);
  const auto sum = [&](int begin, int end) {
    return std::accumulate(weights.begin() + begin, weights.begin() + end, 0.0);
  };
  EXPECT_NEAR(sum(0, 90) + sum(120, 150), 150.0, 1e-3);
  EXPECT_NEAR(sum(0, 300), 300.0, 1e-3);
  EXPECT_NEAR(sum(300, 301), 2.0, 1e-3);
  EXPECT_NEAR(sum(0, 90) / sum(90, 120), 1.0, 0.35);
  EXPECT_NEAR(sum(120, 150) / sum(150, 300), 1.0, 0.35);
}

}  // namespace
}  // namespace samewhere::train
