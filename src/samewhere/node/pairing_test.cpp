#include <gtest/gtest.h>

#include <samewhere/node/pairing.hpp>

namespace samewhere::node {
namespace {

constexpr double kTestTolerance_s = 0.01;

Picture picture_at(double stamp_s) { return {.stamp_s = stamp_s, .frame_id = "", .message = {}}; }

TEST(Pairing, PairsTheNearestStampsWithinTheTolerance) {
  Pairing pairing(true, kTestTolerance_s, 5);
  pairing.add_second(picture_at(0.992));
  pairing.add_second(picture_at(1.003));
  pairing.add_first(picture_at(1.0));
  const auto pair = pairing.next();
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->first.stamp_s, 1.0);
  EXPECT_EQ(pair->second->stamp_s, 1.003);
  EXPECT_EQ(pairing.num_dropped(), 1U);
  EXPECT_FALSE(pairing.next());
}

TEST(Pairing, WaitsForThePartnerWhicheverComesFirst) {
  Pairing pairing(true, kTestTolerance_s, 5);
  pairing.add_first(picture_at(1.0));
  EXPECT_FALSE(pairing.next());
  pairing.add_second(picture_at(1.0));
  EXPECT_TRUE(pairing.next());
  pairing.add_second(picture_at(2.0));
  EXPECT_FALSE(pairing.next());
  pairing.add_first(picture_at(2.0));
  EXPECT_TRUE(pairing.next());
  EXPECT_EQ(pairing.num_dropped(), 0U);
}

TEST(Pairing, DropsAnImageWhosePartnerIsMissing) {
  Pairing pairing(true, kTestTolerance_s, 5);
  pairing.add_first(picture_at(1.0));
  pairing.add_first(picture_at(1.1));
  pairing.add_second(picture_at(1.1));
  const auto pair = pairing.next();
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->first.stamp_s, 1.1);
  EXPECT_EQ(pairing.num_dropped(), 1U);
}

TEST(Pairing, HoldsNoMoreThanItsCapacity) {
  Pairing pairing(true, kTestTolerance_s, 2);
  for (int i = 0; i < 5; ++i) pairing.add_first(picture_at(0.1 * i));
  EXPECT_EQ(pairing.num_dropped(), 3U);
  pairing.add_second(picture_at(0.1));
  pairing.add_second(picture_at(0.3));
  const auto pair = pairing.next();
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->first.stamp_s, 0.1 * 3);
}

TEST(Pairing, DropsWhatComesOutOfOrder) {
  Pairing pairing(false, kTestTolerance_s, 5);
  for (const double stamp_s : {1.0, 1.0, 0.9, 1.1}) pairing.add_first(picture_at(stamp_s));
  EXPECT_EQ(pairing.next()->first.stamp_s, 1.0);
  EXPECT_EQ(pairing.next()->first.stamp_s, 1.1);
  EXPECT_FALSE(pairing.next());
  EXPECT_EQ(pairing.num_dropped(), 2U);
}

TEST(Pairing, BeginsAgainWhereTimeGoesBack) {
  Pairing pairing(true, kTestTolerance_s, 5);
  pairing.add_first(picture_at(100.0));
  pairing.add_second(picture_at(100.0));
  EXPECT_TRUE(pairing.next());
  pairing.add_first(picture_at(3.0));
  pairing.add_second(picture_at(3.0));
  const auto pair = pairing.next();
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->first.stamp_s, 3.0);
}

// Every image is given out or counted, whatever comes.
TEST(Pairing, LosesNoCount) {
  for (int period = 2; period < 6; ++period) {
    Pairing pairing(true, kTestTolerance_s, 3);
    std::uint64_t num_given = 0;
    std::uint64_t num_added = 0;
    for (int i = 1; i <= 60; ++i) {
      const double stamp_s = 0.1 * i;
      if (i % period != 0) pairing.add_first(picture_at(stamp_s));
      if (i % (period + 1) != 0) pairing.add_second(picture_at(stamp_s + 0.004));
      num_added += (i % period != 0 ? 1U : 0U) + (i % (period + 1) != 0 ? 1U : 0U);
      while (pairing.next()) num_given += 2;
    }
    EXPECT_GE(num_given, 40U);
    EXPECT_LE(num_added - num_given - pairing.num_dropped(), 6U) << "every " << period;
  }
}

}  // namespace
}  // namespace samewhere::node
