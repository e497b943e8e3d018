#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/run/recognition.hpp>

namespace samewhere::run {
namespace {

constexpr int kNumPictures = 16;

// A few seconds in the corridor, with a window so short that there is much to find.
pipeline::Config short_walk(const std::string& profile_name) {
  pipeline::Config config = pipeline::profile(profile_name);
  config.source = "twin:office-loop?seed=5";
  config.twin.num_frames = kNumPictures;
  config.retrieve.window_frames = 4;
  config.retrieve.group_size = 10;
  config.retrieve.queue_size = 2;
  config.retrieve.num_draws = 5;  // few enough that the draws matter
  config.verify.pause_frames = 2;
  config.verify.prior = verify::Prior::kUnique;  // else nothing is accepted
  return config;
}

std::vector<core::Frame> frames_of(const pipeline::Config& config) {
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
  core::Random verifying(core::seed_of(seed, "judge", 0));
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
          .verify =
              [steps, random = verifying](const SearchedFrame& frame) mutable {
                EXPECT_GE(dawdle(random), 0.0);
                steps.verify(frame);
              }};
}

// All that a run found, as the bytes that are written.
std::string bytes_of(Recognition recognition) {
  RunOutcome outcome;
  std::move(recognition).report_to(outcome);
  std::string bytes = report::pairs_text(outcome.matches) + report::pairs_text(outcome.accepted) +
                      report::loops_json(outcome.record.ledger);
  for (const auto& [frame, jpeg] : outcome.record.thumbnails) bytes += jpeg;
  EXPECT_EQ(outcome.record.thumbnails.size(), kNumPictures);
  EXPECT_FALSE(outcome.matches.empty());
  EXPECT_FALSE(outcome.accepted.empty());
  EXPECT_EQ(outcome.record.figures.size(), 1U) << "the describer";
  EXPECT_EQ(outcome.record.timings.durations_ms().at(report::kWholeFrameStage).size(),
            kNumPictures);
  return bytes;
}

TEST(Recognition, TheThreadsFindToTheByteWhatOneThreadFindsHoweverTheyDawdle) {
  const std::vector<core::Frame> frames = frames_of(short_walk("default"));
  for (const char* name : {"default", "paper"}) {
    const pipeline::Config config = short_walk(name);
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

}  // namespace
}  // namespace samewhere::run
