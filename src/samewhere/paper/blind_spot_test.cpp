#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/paper/blind_spot.hpp>

namespace samewhere::paper {
namespace {

using testing::HasSubstr;

constexpr std::uint64_t kSeed = 7;

// Views that all differ; the queries are views of the first hundred seen again.
ViewPool pool_of(int num_stored) {
  core::Random random(kSeed);
  ViewPool pool;
  for (int i = 0; i < num_stored; ++i) {
    std::vector<float> vector(32);
    for (float& value : vector) value = static_cast<float>(random.gaussian());
    pool.stored.push_back({core::FrameId(static_cast<std::uint64_t>(i)), core::unit(vector), 1});
  }
  for (std::size_t i = 0; i < 100; ++i) pool.queries.push_back(pool.stored[i]);
  return pool;
}

TEST(BlindSpot, IsAsLargeAsTheFormulaSays) {
  const auto points = measure_blind_spot(pool_of(1000), {}, {10, 50});
  ASSERT_TRUE(points.has_value());
  ASSERT_EQ(points->size(), 8u);  // stores of 100, 200, 500 and 1000 views
  for (const BlindSpotPoint& point : *points) {
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", " << point.num_stored << " views, "
                                    << point.num_draws << " draws");
    EXPECT_NEAR(point.expected, std::pow(1.0 - 10.0 / point.num_stored, point.num_draws), 1e-12);
    const double four_sigma = 4.0 * std::sqrt(point.expected * (1.0 - point.expected) / 500.0);
    EXPECT_NEAR(point.measured, point.expected, four_sigma);
  }
}

TEST(BlindSpot, WhatDoesNotExceedTheThresholdIsMissedThoughItsQueueIsDrawn) {
  ViewPool pool = pool_of(100);
  for (std::size_t i = 0; i < 50; ++i)
    for (float& value : pool.queries[i].unit) value = 0.0F;  // a black view is like none
  const auto points = measure_blind_spot(pool, {}, {1000});
  ASSERT_TRUE(points.has_value());
  EXPECT_EQ(points->front().num_queries, 100);
  EXPECT_EQ(points->front().measured, 0.5);
  EXPECT_LT(points->front().expected, 1e-9);
}

TEST(BlindSpot, WhatOthersSurpassIsMissedThoughItsQueueIsDrawn) {
  // The view that is most like the query by NCC is the fourth by cosine: a common offset, which NCC
  // takes away, makes the other three more similar.
  ViewPool pool;
  const std::vector<float> query{3, 1, -1, 0};
  for (std::uint64_t i = 0; i < 100; ++i) {
    std::vector<float> vector{0, 0, 0, 1};
    if (i < 10) vector = {5, 3, 1, 2};           // the query and an offset: NCC 1, cosine .82
    if (i % 30 == 20) vector = {3, 1, -1, .5F};  // cosine .99
    pool.stored.push_back({core::FrameId(i), core::unit(vector), 1});
  }
  pool.queries.push_back({core::FrameId(0), core::unit(query), 1});
  EXPECT_EQ(measure_blind_spot(pool, {}, {1000})->front().measured, 1.0);
  EXPECT_EQ(measure_blind_spot(pool, {.num_candidates = 4}, {1000})->front().measured, 0.0);
}

TEST(BlindSpot, IsDrawnAndSaidInOneSentence) {
  const std::vector<BlindSpotPoint> points{{100, 50, 0.005, 9, 0.01}, {1000, 50, 0.605, 9, 0.612}};
  EXPECT_THAT(
      blind_spot_sentence(points, 50),
      HasSubstr("Among 1000 views, L = 50 misses the right queue in 61.2 % of the searches; "
                "60.5 % by the draws alone."));
  const std::string svg = blind_spot_svg(points, {});
  EXPECT_THAT(svg, HasSubstr("L = 50, formula"));
  EXPECT_THAT(svg, HasSubstr("L = 50, measured"));
  EXPECT_THAT(svg, HasSubstr("Among 1000 views"));
  EXPECT_EQ(blind_spot_csv(points),
            "views,draws,chance_of_missing,queries,measured\n100,50,0.0050,9,0.0100\n"
            "1000,50,0.6050,9,0.6120\n");
}

}  // namespace
}  // namespace samewhere::paper
