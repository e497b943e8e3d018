#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/timing.hpp>

namespace samewhere::core {
namespace {

TEST(Timing, NothingMeasuredIsAllZero) {
  const TimingSummary summary = summarize({});
  EXPECT_EQ(summary.count, 0);
  EXPECT_EQ(summary.p99_ms, 0.0);
}

TEST(Timing, QuantilesAreMeasuredValuesOfTheirRank) {
  std::vector<double> durations_ms;
  for (int i = 100; i >= 1; --i) durations_ms.push_back(i);  // in any order
  const TimingSummary summary = summarize(durations_ms);
  EXPECT_EQ(summary.count, 100);
  EXPECT_EQ(summary.median_ms, 50.0);
  EXPECT_EQ(summary.p95_ms, 95.0);
  EXPECT_EQ(summary.p99_ms, 99.0);
  EXPECT_EQ(summary.total_ms, 5050.0);
}

TEST(Timing, OneValueIsAllItsQuantiles) {
  const TimingSummary summary = summarize({7.5});
  EXPECT_EQ(summary.median_ms, 7.5);
  EXPECT_EQ(summary.p95_ms, 7.5);
  EXPECT_EQ(summary.p99_ms, 7.5);
}

TEST(Timing, AScopedTimerAddsOneDurationToItsStage) {
  Timings timings;
  { const ScopedTimer timer(timings, "track"); }
  { const ScopedTimer timer(timings, "track"); }
  ASSERT_EQ(timings.durations_ms().count("track"), 1U);
  EXPECT_EQ(timings.durations_ms().at("track").size(), 2U);
  EXPECT_GE(timings.durations_ms().at("track").front(), 0.0);
}

TEST(Timing, WorkCostsProcessorTime) {
  constexpr double kWork_ms = 20.0;
  Timings timings;
  const double program_s = seconds_since_program_start().value();
  {
    const ScopedTimer timer(timings, "work");
    const double start_ms = thread_processor_ms();
    while (thread_processor_ms() < start_ms + kWork_ms) continue;
  }
  EXPECT_GE(timings.processor_ms().at("work"), kWork_ms);
  EXPECT_GE(timings.durations_ms().at("work").front(), kWork_ms - 1.0);
  EXPECT_GE(seconds_since_program_start().value(), program_s);
}

TEST(Timing, AnothersDurationsComeAfterItsOwn) {
  Timings own;
  Timings other;
  own.add("track", 1.0, 0.5);
  other.add("track", 2.0, 0.25);
  other.add("map", 3.0);
  own.add(other);
  EXPECT_EQ(own.processor_ms().at("track"), 0.75);
  EXPECT_EQ(own.durations_ms().at("track"), (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(own.durations_ms().at("map"), std::vector<double>{3.0});
}

TEST(Timing, TellsWhatATimeWasBeside) {
  Timings own;
  Timings other;
  own.add_span("track", 10.0, 11.0, 0.5);  // ends as the work begins
  own.add_span("track", 10.0, 12.0, 0.5);
  own.add_span("track", 12.0, 15.0, 0.5);  // within
  own.add("track", 7.0);                   // at an unknown time
  own.add_span("track", 19.0, 23.0, 0.5);
  own.add_span("track", 20.0, 25.0, 0.5);  // begins as it ends
  other.add_span("bundle", 11.0, 20.0, 1.0);
  own.add(other);
  EXPECT_EQ(own.durations_beside("track", "bundle"), (std::vector<double>{2.0, 3.0, 4.0}));
  EXPECT_EQ(own.durations_beside("bundle", "track"), std::vector<double>{9.0});
  EXPECT_TRUE(own.durations_beside("track", "fuse").empty());
  EXPECT_EQ(own.durations_ms().at("track").size(), 6U);
}

TEST(Timing, PeakMemoryGrowsWithAnAllocationThatIsTouched) {
  const double before_mib = peak_memory_mib();
  // more than was ever there at a time: what is free again would be used first
  const std::vector<char> block(static_cast<std::size_t>(before_mib + 64.0) << 20, 'x');
  EXPECT_EQ(block.back(), 'x');
  EXPECT_GE(peak_memory_mib(), before_mib + 32.0);
  EXPECT_GE(resident_memory_mib(), before_mib + 32.0);
  EXPECT_LE(resident_memory_mib(), peak_memory_mib() + 8.0);
}

}  // namespace
}  // namespace samewhere::core
