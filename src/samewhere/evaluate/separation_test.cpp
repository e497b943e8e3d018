#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/evaluate/separation.hpp>

namespace samewhere::evaluate {
namespace {

TEST(Separation, AScoreThatKnowsKeepsAll) {
  const Separation separation = separation_of({3.0, 5.0, 4.0}, {1.0, 2.0});
  EXPECT_EQ(separation.auc, 1.0);
  EXPECT_EQ(separation.kept_at_0_1_percent, 1.0);
}

TEST(Separation, AScoreThatIsAlwaysTheSameKnowsNothing) {
  const Separation separation = separation_of({1.0, 1.0, 1.0}, {1.0, 1.0});
  EXPECT_EQ(separation.auc, 0.5);
  EXPECT_EQ(separation.kept_at_1_percent, 0.0);
}

TEST(Separation, WithoutPairsOfOneKindNothingIsKnown) {
  EXPECT_EQ(separation_of({}, {1.0}).auc, 0.5);
  EXPECT_EQ(separation_of({1.0}, {}).kept_at_1_percent, 0.0);
}

TEST(Separation, OneWrongPairOfAHundredMayPassAtOnePercent) {
  std::vector<double> wrong(99, 0.0);
  wrong.push_back(10.0);
  const Separation separation = separation_of({5.0, 5.0, 20.0, -1.0}, wrong);
  EXPECT_EQ(separation.kept_at_1_percent, 0.75);
  EXPECT_EQ(separation.kept_at_0_1_percent, 0.25);
}

TEST(Separation, TheAreaIsTheShareOfPairsInTheRightOrder) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    core::Random random(seed);
    std::vector<double> right;
    std::vector<double> wrong;
    for (int i = 0; i < 40; ++i) right.push_back(1.0 + static_cast<double>(random.index(8)));
    for (int i = 0; i < 30; ++i) wrong.push_back(static_cast<double>(random.index(8)));
    double wins = 0.0;
    for (const double a : right)
      for (const double b : wrong) wins += a > b ? 1.0 : a == b ? 0.5 : 0.0;
    EXPECT_NEAR(separation_of(right, wrong).auc, wins / (40 * 30), 1e-12)
        << fmt::format("seed {}", seed);
  }
}

}  // namespace
}  // namespace samewhere::evaluate
