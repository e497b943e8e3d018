#include <csignal>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/progress.hpp>

namespace samewhere::core {
namespace {

TEST(Progress, ShortWorkPrintsNothing) {
  testing::internal::CaptureStderr();
  {
    Progress progress("frames", 1000);
    for (int i = 1; i <= 1000; ++i) progress.update(i);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Progress, LongWorkPrintsALineWhereverItIsACountOutsideTheTotalIncluded) {
  testing::internal::CaptureStderr();
  {
    Progress progress("frames", 10);
    const auto start = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - start < std::chrono::milliseconds(600)) {
    }
    progress.update(5, "tracking, 2 loops");
    progress.update(12);
  }
  const std::string printed = testing::internal::GetCapturedStderr();
  EXPECT_THAT(printed, testing::HasSubstr(" left  tracking, 2 loops\n"));
  EXPECT_THAT(printed, testing::HasSubstr("frames 5/10"));
  EXPECT_THAT(printed, testing::HasSubstr("frames 10/10"));
}

TEST(Progress, QuietWorkPrintsNothingHoweverLongItIs) {
  testing::internal::CaptureStderr();
  {
    Progress progress("frames", 10, true);
    const auto start = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - start < std::chrono::milliseconds(510)) {
    }
    progress.update(10);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Progress, OutsideATerminalWorkWithoutATotalPrintsNothingBeforeAMinute) {
  testing::internal::CaptureStderr();
  {
    Progress progress("frames", 0);
    const auto start = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - start < std::chrono::milliseconds(510)) {
    }
    progress.update(10);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Interrupt, TheFirstSignalOnlySetsAFlagAndTheSecondEndsTheProcess) {
  EXPECT_EXIT(
      {
        catch_interrupts();
        if (is_interrupted()) std::_Exit(1);
        std::raise(SIGINT);
        if (!is_interrupted()) std::_Exit(2);
        std::raise(SIGTERM);  // of either kind
        std::_Exit(3);
      },
      testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace samewhere::core
