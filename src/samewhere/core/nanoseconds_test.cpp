#include <gtest/gtest.h>

#include <samewhere/core/nanoseconds.hpp>

namespace samewhere::core {
namespace {

TEST(Nanoseconds, DecimalStampsComeBackUnchanged) {
  for (const double stamp_s : {0.0, 0.1, 0.033333333, 12.1, 4.7, 86399.999999999, -0.25,
                               1305031102.175304, 1700000000.123456}) {
    EXPECT_EQ(in_whole_nanoseconds(stamp_s), stamp_s);
  }
}

TEST(Nanoseconds, OtherStampsMoveByLessThanOne) {
  for (int i = 0; i < 1000; ++i) {
    const double stamp_s = i / 30.0;
    EXPECT_NEAR(in_whole_nanoseconds(stamp_s), stamp_s, 0.51e-9);
    EXPECT_EQ(in_whole_nanoseconds(in_whole_nanoseconds(stamp_s)), in_whole_nanoseconds(stamp_s));
  }
}

TEST(Nanoseconds, WhatIsNoStampHasABound) {
  EXPECT_GT(nanoseconds_of(1e300), 0);
  EXPECT_LT(nanoseconds_of(-1e300), 0);
}

}  // namespace
}  // namespace samewhere::core
