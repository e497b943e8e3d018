#include <gtest/gtest.h>

#include <samewhere/track/scale_drift_detector.hpp>

namespace samewhere::track {
namespace {

constexpr double kRate_hz = 30.0;

class ScaleDriftDetectorTest : public ::testing::Test {
 protected:
  // Moves at this speed and depth; the last result.
  std::optional<double> walk(double seconds, double speed, double depth) {
    std::optional<double> found;
    for (int i = 0; i < seconds * kRate_hz; ++i) {
      stamp_s_ += 1.0 / kRate_hz;
      found = detector_.update(stamp_s_, speed / kRate_hz, depth);
      if (found) ++num_found_;
    }
    return found;
  }

  ScaleDriftDetector detector_{4.0};
  double stamp_s_ = 0.0;
  int num_found_ = 0;
};

TEST_F(ScaleDriftDetectorTest, DetectsSmallerLengthsWithTheirFactor) {
  EXPECT_FALSE(walk(20.0, 1.0, 3.0));
  const auto found = walk(5.0, 0.1, 0.3);
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 0.1, 0.01);
  // a window of two seconds, then the time that a change has to last
  EXPECT_GT(num_found_, 1.0 * kRate_hz);
  EXPECT_LT(num_found_, 3.5 * kRate_hz);
}

TEST_F(ScaleDriftDetectorTest, DetectsLargerLengths) {
  walk(20.0, 1.0, 3.0);
  const auto found = walk(5.0, 8.0, 24.0);
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 8.0, 0.5);
}

TEST_F(ScaleDriftDetectorTest, IgnoresAStandingCameraAndAWall) {
  walk(20.0, 1.0, 3.0);
  walk(10.0, 0.01, 3.0);  // stands
  walk(10.0, 1.0, 3.0);
  walk(10.0, 0.01, 0.3);  // stands close to a wall
  walk(10.0, 1.0, 0.3);   // walks along a wall
  EXPECT_EQ(num_found_, 0);
}

TEST_F(ScaleDriftDetectorTest, IgnoresAFactorOfTwo) {
  walk(20.0, 1.0, 3.0);
  walk(10.0, 0.4, 1.2);
  walk(10.0, 2.5, 7.5);
  EXPECT_EQ(num_found_, 0);
}

TEST_F(ScaleDriftDetectorTest, ResetForgetsTheUsualLengths) {
  walk(20.0, 1.0, 3.0);
  detector_.reset();
  EXPECT_FALSE(walk(20.0, 0.1, 0.3));
}

TEST_F(ScaleDriftDetectorTest, IgnoresGapsBetweenFrames) {
  walk(20.0, 1.0, 3.0);
  for (int i = 0; i < 100; ++i) {
    stamp_s_ += 2.0;
    EXPECT_FALSE(detector_.update(stamp_s_, 0.05, 0.3));
  }
}

TEST_F(ScaleDriftDetectorTest, ZeroDetectsNothing) {
  detector_ = ScaleDriftDetector(0.0);
  walk(20.0, 1.0, 3.0);
  EXPECT_FALSE(walk(10.0, 0.01, 0.03));
}

TEST(ScaleDriftIntervals, JoinConsecutiveFramesAndKeepTheLargestFactor) {
  std::vector<ScaleDriftInterval> intervals;
  add_to_intervals(intervals, core::FrameId(7), 0.2);
  add_to_intervals(intervals, core::FrameId(8), 0.1);
  add_to_intervals(intervals, core::FrameId(9), 0.15);
  add_to_intervals(intervals, core::FrameId(20), 5.0);
  ASSERT_EQ(intervals.size(), 2U);
  EXPECT_EQ(intervals[0].first, core::FrameId(7));
  EXPECT_EQ(intervals[0].last, core::FrameId(9));
  EXPECT_EQ(intervals[0].factor, 0.1);
  EXPECT_EQ(intervals[1].first, core::FrameId(20));
}

TEST(LogMedian, IsExactToABinAndAcceptsExtremes) {
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
