#include <algorithm>

#include <gtest/gtest.h>

#include <samewhere/core/median.hpp>
#include <samewhere/core/random.hpp>

namespace samewhere::core {
namespace {

TEST(Median, IsTheMiddleValueAndTheUpperOfTwo) {
  EXPECT_EQ(median(std::vector{7.0}), 7.0);
  EXPECT_EQ(median(std::vector{3, 1, 2}), 2);
  EXPECT_EQ(median(std::vector{4.0F, 1.0F, 3.0F, 2.0F}), 3.0F);
}

TEST(Median, OfNothingIsNothing) { EXPECT_EQ(median(std::vector<double>{}), std::nullopt); }

TEST(Median, IsWhatSortingSaysInAnyOrder) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    std::vector<int> values(1 + random.index(50));
    for (int& value : values) value = static_cast<int>(random.index(20));  // some are equal
    std::vector<int> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(median(values), sorted[sorted.size() / 2]) << "seed " << seed;
  }
}

}  // namespace
}  // namespace samewhere::core
