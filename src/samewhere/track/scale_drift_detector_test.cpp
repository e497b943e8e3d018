#include <gtest/gtest.h>

#include <samewhere/track/scale_drift_detector.hpp>

namespace samewhere::track {
namespace {

constexpr double kRate_hz = 30.0;

class ScaleWatchTest : public ::testing::Test {
 protected:
  // So many seconds at this speed and depth; what was found last.
  std::optional<double> walk(double seconds, double speed, double depth) {
    std::optional<double> found;
    for (int i = 0; i < seconds * kRate_hz; ++i) {
      stamp_s_ += 1.0 / kRate_hz;
      found = watch_.see(stamp_s_, speed / kRate_hz, depth);
      if (found) ++num_found_;
    }
    return found;
  }

  ScaleWatch watch_{4.0};
  double stamp_s_ = 0.0;
  int num_found_ = 0;
};

TEST_F(ScaleWatchTest, LengthsThatShrinkTogetherAreNoticedWithTheirFactor) {
  EXPECT_FALSE(walk(20.0, 1.0, 3.0));
  const auto found = walk(5.0, 0.1, 0.3);
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 0.1, 0.01);
  // two seconds of medians and a moment that it must last
  EXPECT_GT(num_found_, 1.0 * kRate_hz);
  EXPECT_LT(num_found_, 3.5 * kRate_hz);
}

TEST_F(ScaleWatchTest, LengthsThatGrowTogetherAreNoticed) {
  walk(20.0, 1.0, 3.0);
  const auto found = walk(5.0, 8.0, 24.0);
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 8.0, 0.5);
}

TEST_F(ScaleWatchTest, StandingStillOrBeforeAWallIsNone) {
  walk(20.0, 1.0, 3.0);
  walk(10.0, 0.01, 3.0);  // stands
  walk(10.0, 1.0, 3.0);
  walk(10.0, 0.01, 0.3);  // stands before a wall
  walk(10.0, 1.0, 0.3);   // walks along a wall
  EXPECT_EQ(num_found_, 0);
}

TEST_F(ScaleWatchTest, HalfOrTwiceIsNone) {
  walk(20.0, 1.0, 3.0);
  walk(10.0, 0.4, 1.2);
  walk(10.0, 2.5, 7.5);
  EXPECT_EQ(num_found_, 0);
}

TEST_F(ScaleWatchTest, WhatIsUsualIsOfThisMapAlone) {
  walk(20.0, 1.0, 3.0);
  watch_.forget();
  EXPECT_FALSE(walk(20.0, 0.1, 0.3));
}

TEST_F(ScaleWatchTest, AGapTellsNoSpeed) {
  walk(20.0, 1.0, 3.0);
  for (int i = 0; i < 100; ++i) {
    stamp_s_ += 2.0;
    EXPECT_FALSE(watch_.see(stamp_s_, 0.05, 0.3));
  }
}

TEST_F(ScaleWatchTest, ZeroNoticesNothing) {
  watch_ = ScaleWatch(0.0);
  walk(20.0, 1.0, 3.0);
  EXPECT_FALSE(walk(10.0, 0.01, 0.03));
}

TEST(ScaleDoubts, AreRowsOfFramesWithTheFarthestFactor) {
  std::vector<ScaleDoubt> doubts;
  note_doubt(doubts, core::FrameId(7), 0.2);
  note_doubt(doubts, core::FrameId(8), 0.1);
  note_doubt(doubts, core::FrameId(9), 0.15);
  note_doubt(doubts, core::FrameId(20), 5.0);
  ASSERT_EQ(doubts.size(), 2U);
  EXPECT_EQ(doubts[0].first, core::FrameId(7));
  EXPECT_EQ(doubts[0].last, core::FrameId(9));
  EXPECT_EQ(doubts[0].factor, 0.1);
  EXPECT_EQ(doubts[1].first, core::FrameId(20));
}

TEST(LogMedian, IsWithinAStepAndHoldsExtremes) {
  LogMedian median;
  for (int i = 1; i <= 101; ++i) median.add(i);
  EXPECT_NEAR(median.value(), 51.0, 0.05 * 51.0);
  for (int i = 0; i < 300; ++i) median.add(1e300);
  EXPECT_GT(median.value(), 1e10);
  for (int i = 0; i < 1000; ++i) median.add(1e-300);
  EXPECT_LT(median.value(), 1e-10);
}

}  // namespace
}  // namespace samewhere::track
