#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/input/associate.hpp>

namespace samewhere::input {
namespace {

using testing::ElementsAre;
using testing::Eq;
using testing::Optional;

TEST(Associate, TheNearestInTimeWins) {
  EXPECT_THAT(associate({1.0, 2.0}, {0.99, 1.005, 1.995, 2.01}, 0.02),
              ElementsAre(Optional(1U), Optional(2U)));
}

TEST(Associate, ADepthImageIsUsedOnceByTheColourImageNearestToIt) {
  EXPECT_THAT(associate({1.000, 1.010}, {1.009}, 0.02),
              ElementsAre(Eq(std::nullopt), Optional(0U)));
}

TEST(Associate, TooFarInTimeIsNoPartner) {
  EXPECT_THAT(associate({1.0, 2.0}, {1.03, 2.01}, 0.02),
              ElementsAre(Eq(std::nullopt), Optional(1U)));
  EXPECT_THAT(associate({1.0}, {}, 0.02), ElementsAre(Eq(std::nullopt)));
}

// All pairs, again and again, without any cleverness.
std::vector<std::optional<std::size_t>> slow_associate(const std::vector<double>& colours,
                                                       const std::vector<double>& depths,
                                                       double max_difference_s) {
  std::vector<std::optional<std::size_t>> partners(colours.size());
  std::vector<bool> is_used(depths.size());
  while (true) {
    double best_s = max_difference_s;
    std::optional<std::pair<std::size_t, std::size_t>> best;
    for (std::size_t c = 0; c < colours.size(); ++c) {
      for (std::size_t d = 0; d < depths.size(); ++d) {
        const double difference_s = std::abs(depths[d] - colours[c]);
        if (partners[c] || is_used[d] || difference_s >= best_s) continue;
        best_s = difference_s;
        best = {c, d};
      }
    }
    if (!best) return partners;
    partners[best->first] = best->second;
    is_used[best->second] = true;
  }
}

TEST(Associate, TheFastWayAgreesWithTheSlowOne) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    core::Random random(seed);
    std::vector<double> colours(random.index(30));
    std::vector<double> depths(random.index(30));
    for (double& stamp_s : colours) stamp_s = random.uniform();
    for (double& stamp_s : depths) stamp_s = random.uniform();
    std::sort(colours.begin(), colours.end());
    std::sort(depths.begin(), depths.end());
    const double max_difference_s = random.uniform(0.0, 0.1);
    EXPECT_EQ(associate(colours, depths, max_difference_s),
              slow_associate(colours, depths, max_difference_s))
        << "seed " << seed;
  }
}

}  // namespace
}  // namespace samewhere::input
