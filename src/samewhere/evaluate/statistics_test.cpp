#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/evaluate/statistics.hpp>

namespace samewhere::evaluate {
namespace {

TEST(MeanAndDeviation, OfAKnownSampleIsKnown) {
  const MeanDeviation four = mean_and_deviation({2.0, 4.0, 4.0, 6.0});
  EXPECT_NEAR(four.mean, 4.0, 1e-12);
  EXPECT_NEAR(four.deviation, std::sqrt(8.0 / 3.0), 1e-12);
  EXPECT_EQ(mean_and_deviation({7.0}).mean, 7.0);
  EXPECT_EQ(mean_and_deviation({7.0}).deviation, 0.0);
  EXPECT_EQ(mean_and_deviation({}).mean, 0.0);
}

TEST(ChanceOfMissing, IsWhatDrawingMeasures) {
  constexpr int kNumTrials = 20'000;
  for (const auto& [num_queues, num_draws] :
       {std::pair{10, 10}, std::pair{90, 50}, std::pair{100, 70}, std::pair{1, 3}}) {
    constexpr std::uint64_t kSeed = 5;
    SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", " << num_queues << " queues");
    core::Random random(kSeed);
    int num_missed = 0;
    for (int trial = 0; trial < kNumTrials; ++trial) {
      bool is_missed = true;
      for (int draw = 0; draw < num_draws; ++draw)
        is_missed &= random.index(static_cast<std::uint64_t>(num_queues)) != 0;
      num_missed += is_missed ? 1 : 0;
    }
    const double expected = chance_of_missing(num_queues, num_draws);
    const double four_sigma = 4.0 * std::sqrt(expected * (1.0 - expected) / kNumTrials);
    EXPECT_NEAR(static_cast<double>(num_missed) / kNumTrials, expected, four_sigma);
  }
}

TEST(ChanceOfMissing, NeedsSomethingToDraw) {
  EXPECT_THROW(chance_of_missing(0, 1), core::ContractError);
  EXPECT_THROW(chance_of_missing(10, 0), core::ContractError);
}

}  // namespace
}  // namespace samewhere::evaluate
