#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/verify/overlap.hpp>

namespace samewhere::verify {
namespace {

const cv::Size kSize{640, 480};

// Pairs all over the first picture; in the second everything is zoomed about the middle, and
// shifted. Of `num_chance` of them only the row is right.
geometry::PixelPairs laid(double zoom, const Eigen::Vector2d& shift_px, int num_chance = 0) {
  core::Random random(7);
  const Eigen::Vector2d middle(320.0, 240.0);
  geometry::PixelPairs pairs;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d first(random.uniform(0.0, 640.0), random.uniform(0.0, 480.0));
    Eigen::Vector2d second = zoom * (first - middle) + middle + shift_px;
    if (i < num_chance) second.x() = random.uniform(0.0, 640.0);
    pairs.first_px.push_back(first);
    pairs.second_px.push_back(second);
  }
  return pairs;
}

double overlap(const geometry::PixelPairs& pairs) { return overlap_ratio(pairs, kSize, kSize); }

TEST(Overlap, IsTheShareOfThePictureThatBothShow) {
  EXPECT_NEAR(overlap(laid(1.0, {0.0, 0.0})), 1.0, 1e-6);
  EXPECT_NEAR(overlap(laid(1.0, {320.0, 0.0})), 0.5, 1e-6);
  EXPECT_NEAR(overlap(laid(1.0, {-160.0, 240.0})), 0.375, 1e-6);
  EXPECT_NEAR(overlap(laid(1.0, {700.0, 0.0})), 0.0, 1e-6);
}

TEST(Overlap, IsTheSmallerShareWhereOneStandsNearer) {
  EXPECT_NEAR(overlap(laid(2.0, {0.0, 0.0})), 0.25, 1e-6);
  EXPECT_NEAR(overlap(laid(0.5, {0.0, 0.0})), 0.25, 1e-6);
}

TEST(Overlap, IsNotLedAstrayByPairsThatAgreeByChance) {
  EXPECT_NEAR(overlap(laid(1.0, {320.0, 0.0}, 40)), 0.5, 0.02);
}

TEST(Overlap, IsUnknownForFewPairsOrForOnePoint) {
  EXPECT_EQ(overlap({}), 0.0);
  geometry::PixelPairs pairs = laid(1.0, {0.0, 0.0});
  pairs.first_px.resize(3);
  pairs.second_px.resize(3);
  EXPECT_EQ(overlap(pairs), 0.0);
  EXPECT_EQ(overlap({std::vector<Eigen::Vector2d>(9, {5.0, 5.0}),
                     std::vector<Eigen::Vector2d>(9, {7.0, 7.0})}),
            0.0);
}

}  // namespace
}  // namespace samewhere::verify
