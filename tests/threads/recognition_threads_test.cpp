// Parallel steps of recognition; nothing is rendered, so that the sanitizers take little time.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/run/recognition.hpp>

namespace samewhere::run {
namespace {

// Steps that only pass on the number of a frame.
RecognitionSteps counting(std::vector<std::uint64_t>& verified) {
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
          .verify =
              [&verified](const SearchedFrame& frame) {
                verified.push_back(frame.described.view.frame.index());
              }};
}

NextFrame numbered(std::uint64_t num_frames) {
  return [num_frames, next = std::uint64_t{0}]() mutable {
    std::optional<core::Frame> frame;
    if (next < num_frames) frame.emplace().id = core::FrameId(next++);
    return frame;
  };
}

TEST(RecognitionThreads, EveryFramePassesEveryStepInOrder) {
  for (const auto run : {run_in_turn, run_in_threads}) {
    for (const std::uint64_t num_frames : {0, 1, 3, 1000}) {
      std::vector<std::uint64_t> verified;
      run(numbered(num_frames), counting(verified));
      ASSERT_EQ(verified.size(), num_frames);
      EXPECT_TRUE(std::is_sorted(verified.begin(), verified.end()));
    }
  }
}

TEST(RecognitionThreads, AnExceptionInAnyStepIsRethrownWithoutDeadlock) {
  for (const auto run : {run_in_turn, run_in_threads}) {
    std::vector<std::uint64_t> verified;
    const auto fail_at_7 = [](core::FrameId frame) {
      if (frame.index() == 7) throw core::InputError("no frame 7");
    };
    const RecognitionSteps plain = counting(verified);
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
    steps.verify = [&](const SearchedFrame& frame) { fail_at_7(frame.described.view.frame); };
    EXPECT_THROW(run(numbered(1000), steps), core::InputError);
    const NextFrame broken = []() -> std::optional<core::Frame> {
      throw core::InputError("cut short");
    };
    EXPECT_THROW(run(broken, plain), core::InputError);
  }
}

// An image of random squares; each number gives another one.
cv::Mat wall(std::uint64_t number) {
  core::Random random(number);
  cv::Mat picture(120, 160, CV_8UC3, cv::Scalar::all(128));
  for (int i = 0; i < 60; ++i) {
    const cv::Rect square(static_cast<int>(random.index(140)), static_cast<int>(random.index(100)),
                          20, 20);
    picture(square).setTo(cv::Scalar::all(static_cast<double>(random.index(256))));
  }
  return picture;
}

// Three different images, twice.
NextFrame two_laps() {
  return [next = std::uint64_t{0}]() mutable {
    std::optional<core::Frame> frame;
    if (next == 6) return frame;
    frame.emplace();
    frame->id = core::FrameId(next);
    frame->rig = std::make_shared<core::Rig>();
    frame->images.push_back(wall(next % 3));
    ++next;
    return frame;
  };
}

std::string found_by(const pipeline::Config& config, decltype(run_in_turn)* run) {
  cv::setNumThreads(1);
  Recognition recognition(config);
  run(two_laps(), recognition.steps());
  RunOutcome outcome;
  std::move(recognition).report_to(outcome);
  EXPECT_EQ(outcome.matches.size(), 3U) << "each wall is matched in the second lap";
  EXPECT_EQ(outcome.record.thumbnails.size(), 6U);
  return report::pairs_text(outcome.matches) + report::loops_json(outcome.record.ledger);
}

TEST(RecognitionThreads, ResultsOnRealImagesEqualThoseOfOneThread) {
  for (const char* name : {"default", "paper"}) {
    pipeline::Config config = pipeline::profile(name);
    config.retrieve.window_frames = 2;
    config.retrieve.num_draws = 1000;
    EXPECT_EQ(found_by(config, run_in_threads), found_by(config, run_in_turn)) << name;
  }
}

}  // namespace
}  // namespace samewhere::run
