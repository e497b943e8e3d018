#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/pipeline/open_source.hpp>
#include <samewhere/pipeline/recognition.hpp>
#include <samewhere/report/loops.hpp>

namespace samewhere::pipeline {
namespace {

constexpr int kNumFrames = 16;

// A few seconds in the corridor, with a window so short that there is much to find.
Config short_walk(const std::string& profile_name) {
  Config config = profile(profile_name);
  config.source = "twin:office-loop?seed=5";
  config.twin.num_frames = kNumFrames;
  config.retrieve.window_frames = 4;
  config.retrieve.group_size = 10;
  config.retrieve.queue_size = 2;
  config.retrieve.num_draws = 5;  // few enough that the draws matter
  config.verify.pause_frames = 2;
  return config;
}

std::vector<core::Frame> frames_of(const Config& config) {
  cv::setNumThreads(1);
  std::vector<core::Frame> frames;
  const auto source = open_source(config);
  while (auto frame = source->next()) frames.push_back(std::move(*frame));
  return frames;
}

NextFrame one_by_one(const std::vector<core::Frame>& frames) {
  return [&frames, next = std::size_t{0}]() mutable {
    return next < frames.size() ? std::optional(frames[next++]) : std::nullopt;
  };
}

// Keeps a thread busy for up to about 20 ms.
double dawdle(core::Random& random) {
  double sum = 0.0;
  const auto num_turns = random.index(1'000'000);
  for (std::uint64_t i = 0; i < num_turns; ++i) sum += std::sqrt(static_cast<double>(i));
  return sum;
}

// The same steps, each as slow at each frame as the seed wants it.
RecognitionSteps slowed(const RecognitionSteps& steps, std::uint64_t seed) {
  core::Random describing(core::seed_of(seed, "describe", 0));
  core::Random searching(core::seed_of(seed, "search", 0));
  core::Random judging(core::seed_of(seed, "judge", 0));
  return {.describe =
              [steps, random = describing](const core::Frame& frame) mutable {
                EXPECT_GE(dawdle(random), 0.0);
                return steps.describe(frame);
              },
          .search =
              [steps, random = searching](DescribedFrame frame) mutable {
                EXPECT_GE(dawdle(random), 0.0);
                return steps.search(std::move(frame));
              },
          .judge =
              [steps, random = judging](const SearchedFrame& frame) mutable {
                EXPECT_GE(dawdle(random), 0.0);
                steps.judge(frame);
              }};
}

// All that a run found, as the bytes that are written.
std::string bytes_of(Recognition recognition) {
  RunOutcome outcome;
  std::move(recognition).report_to(outcome);
  std::string bytes = report::pairs_text(outcome.matches) + report::pairs_text(outcome.accepted) +
                      report::loops_json(outcome.record.ledger);
  for (const auto& [frame, jpeg] : outcome.record.thumbnails) bytes += jpeg;
  EXPECT_EQ(outcome.record.thumbnails.size(), kNumFrames);
  EXPECT_FALSE(outcome.matches.empty());
  EXPECT_FALSE(outcome.accepted.empty());
  EXPECT_EQ(outcome.record.timings.durations_ms().at(report::kWholeFrameStage).size(), kNumFrames);
  return bytes;
}

TEST(Recognition, TheThreadsFindToTheByteWhatOneThreadFindsHoweverTheyDawdle) {
  const std::vector<core::Frame> frames = frames_of(short_walk("default"));
  for (const char* name : {"default", "paper"}) {
    const Config config = short_walk(name);
    Recognition in_turn(config);
    run_in_turn(one_by_one(frames), in_turn.steps());
    const std::string expected = bytes_of(std::move(in_turn));
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      Recognition in_threads(config);
      run_in_threads(one_by_one(frames), slowed(in_threads.steps(), seed));
      EXPECT_EQ(bytes_of(std::move(in_threads)), expected) << name << ", seed " << seed;
    }
  }
}

// Steps that hand on a frame's number and do nothing else.
RecognitionSteps counting(std::vector<std::uint64_t>& judged) {
  return {.describe =
              [](const core::Frame& frame) {
                DescribedFrame described;
                described.view.frame = frame.id;
                return described;
              },
          .search =
              [](DescribedFrame described) {
                SearchedFrame searched;
                searched.described = std::move(described);
                return searched;
              },
          .judge =
              [&judged](const SearchedFrame& frame) {
                judged.push_back(frame.described.view.frame.index());
              }};
}

NextFrame numbered(std::uint64_t num_frames) {
  return [num_frames, next = std::uint64_t{0}]() mutable {
    std::optional<core::Frame> frame;
    if (next < num_frames) frame.emplace().id = core::FrameId(next++);
    return frame;
  };
}

TEST(Recognition, EveryFrameComesToEveryStepInOrder) {
  for (const auto run : {run_in_turn, run_in_threads}) {
    for (const std::uint64_t num_frames : {0, 1, 3, 1000}) {
      std::vector<std::uint64_t> judged;
      run(numbered(num_frames), counting(judged));
      ASSERT_EQ(judged.size(), num_frames);
      EXPECT_TRUE(std::is_sorted(judged.begin(), judged.end()));
    }
  }
}

TEST(Recognition, WhatAnyStepThrowsComesOutAndNobodyWaitsForever) {
  for (const auto run : {run_in_turn, run_in_threads}) {
    std::vector<std::uint64_t> judged;
    const auto fail_at_7 = [](core::FrameId frame) {
      if (frame.index() == 7) throw core::InputError("no frame 7");
    };
    const RecognitionSteps plain = counting(judged);
    RecognitionSteps steps = plain;
    steps.describe = [&](const core::Frame& frame) {
      fail_at_7(frame.id);
      return plain.describe(frame);
    };
    EXPECT_THROW(run(numbered(1000), steps), core::InputError);
    steps = plain;
    steps.search = [&](DescribedFrame frame) {
      fail_at_7(frame.view.frame);
      return plain.search(std::move(frame));
    };
    EXPECT_THROW(run(numbered(1000), steps), core::InputError);
    steps = plain;
    steps.judge = [&](const SearchedFrame& frame) { fail_at_7(frame.described.view.frame); };
    EXPECT_THROW(run(numbered(1000), steps), core::InputError);
    const NextFrame broken = []() -> std::optional<core::Frame> {
      throw core::InputError("cut short");
    };
    EXPECT_THROW(run(broken, plain), core::InputError);
  }
}

}  // namespace
}  // namespace samewhere::pipeline
