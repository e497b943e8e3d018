// What happens when the camera sees badly for a while.

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/random.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/twin/front/twin.hpp>

namespace samewhere::pipeline {
namespace {

constexpr int kNumFrames = 120;  // 8 s
constexpr double kRight_m = 0.1;
// after the dark the old map is seen from afar
constexpr double kRightFromAfar_m = 0.15;

// How many frames of a walk have a pose, and how many of these poses are right.
struct Outcome {
  int num_fed = 0;
  int num_measured = 0;
  int num_right = 0;
  std::vector<bool> is_measured;  // per frame of the walk; false: dropped too
  std::vector<bool> is_right;
};

// A frame as it reaches the program; nothing: it does not.
using Disturb = std::function<std::optional<core::Frame>(core::Frame)>;

Config walk_config() {
  Config config;
  config.source = "twin:office-loop?seed=7";
  config.twin.num_frames = kNumFrames;
  config.retrieve.window_frames = 75;
  return config;
}

struct RenderedWalk {
  std::vector<core::Frame> frames;
  core::Trajectory truth;
};

// Rendered once: that takes longer than to track it.
const RenderedWalk& walk() {
  static const RenderedWalk walk = [] {
    const Config config = walk_config();
    const auto source = twin::open_twin(config.source, config.twin);
    RenderedWalk rendered{{}, source->truth().trajectory};
    while (auto frame = source->next()) rendered.frames.push_back(std::move(*frame));
    return rendered;
  }();
  return walk;
}

// With pictures of its own, to be disturbed.
core::Frame copy_of(const core::Frame& frame) {
  core::Frame copy = frame;
  copy.images[0] = frame.images[0].clone();
  copy.depth_m = frame.depth_m->clone();
  return copy;
}

Outcome outcome_of(const Disturb& disturb, double right_m = kRight_m,
                   const Config& config = walk_config()) {
  cv::setNumThreads(1);
  const core::Trajectory& truth = walk().truth;
  Slam slam(config);
  Outcome outcome{.is_measured = std::vector<bool>(kNumFrames, false),
                  .is_right = std::vector<bool>(kNumFrames, false)};
  std::vector<std::size_t> fed;
  for (const core::Frame& frame : walk().frames) {
    const std::size_t position = frame.id.index();
    auto disturbed = disturb(copy_of(frame));
    if (!disturbed) continue;
    disturbed->id = core::FrameId(fed.size());
    fed.push_back(position);
    slam.feed(*disturbed);
  }
  slam.finish();
  outcome.num_fed = static_cast<int>(fed.size());
  for (std::size_t i = 0; i < fed.size(); ++i) {
    const core::FramePose& pose = slam.frames()[i];
    if (!pose.is_measured) continue;
    ++outcome.num_measured;
    outcome.is_measured[fed[i]] = true;
    const core::Rigid3 found =
        world_from_body(slam.map(), pose.reference_keyframe) * pose.reference_from_frame;
    const core::Rigid3 expected =
        inverse(truth[fed[0]].world_from_camera) * truth[fed[i]].world_from_camera;
    outcome.is_right[fed[i]] = (inverse(expected) * found).translation.norm() < right_m;
    outcome.num_right += outcome.is_right[fed[i]] ? 1 : 0;
  }
  return outcome;
}

bool is_between(const core::Frame& frame, std::size_t first, std::size_t last) {
  return frame.id.index() >= first && frame.id.index() <= last;
}

std::optional<core::Frame> darkened(core::Frame frame, std::size_t first, std::size_t last) {
  if (is_between(frame, first, last)) {
    frame.images[0] = cv::Mat::zeros(frame.images[0].size(), frame.images[0].type());
    frame.depth_m->setTo(0.0);
  }
  return frame;
}

TEST(Disturbance, InTwoSecondsOfDarkThereIsNoPoseAndThenThereIsARightOneAgain) {
  const Outcome outcome = outcome_of(
      [](core::Frame frame) { return darkened(std::move(frame), 50, 79); }, kRightFromAfar_m);
  for (std::size_t i = 50; i <= 79; ++i) EXPECT_FALSE(outcome.is_measured[i]) << i;
  EXPECT_GE(outcome.num_measured, 80) << "of the 90 in light";
  EXPECT_EQ(outcome.num_right, outcome.num_measured);
}

TEST(Disturbance, WhereALampFailsTheDepthPicturesHoldThePose) {
  const Outcome outcome = outcome_of([](core::Frame frame) {
    if (is_between(frame, 50, 79)) frame.images[0].setTo(0);
    return std::optional(frame);
  });
  EXPECT_EQ(outcome.num_measured, kNumFrames);
  EXPECT_EQ(outcome.num_right, kNumFrames);
}

TEST(Disturbance, WhereTheyLeaveADirectionOpenThereIsNoPoseInTheDark) {
  const Outcome outcome = outcome_of(
      [](core::Frame frame) {
        if (is_between(frame, 80, 109)) frame.images[0].setTo(0);
        return std::optional(frame);
      },
      kRightFromAfar_m);
  EXPECT_TRUE(outcome.is_measured[82]);
  EXPECT_FALSE(outcome.is_measured[100]) << "down a corridor";
  for (std::size_t i = 80; i <= 109; ++i)
    EXPECT_EQ(outcome.is_right[i], outcome.is_measured[i]) << "frame " << i;
  EXPECT_GE(outcome.num_right, outcome.num_measured - 1) << "one on few features, as it is found";
}

TEST(Disturbance, ABlurOfTenFramesCostsNoPose) {
  for (const double sigma_px : {4.0, 16.0}) {
    const Outcome outcome = outcome_of([&](core::Frame frame) {
      cv::Mat& image = frame.images[0];
      if (is_between(frame, 50, 59)) cv::GaussianBlur(image, image, {}, sigma_px);
      return std::optional(frame);
    });
    EXPECT_EQ(outcome.num_measured, kNumFrames) << sigma_px;
    EXPECT_EQ(outcome.num_right, kNumFrames) << sigma_px;
  }
}

// Of which frames there is a pose, and how far they are off after the scale.
std::pair<std::vector<bool>, double> without_depth(std::size_t first_dark, std::size_t last_dark) {
  cv::setNumThreads(1);
  Slam slam(walk_config(), DepthFrom::kMotion);
  for (const core::Frame& frame : walk().frames) {
    core::Frame dark = *darkened(copy_of(frame), first_dark, last_dark);
    dark.depth_m.reset();
    slam.feed(dark);
  }
  slam.finish();
  std::vector<bool> is_measured;
  for (const core::FramePose& pose : slam.frames()) is_measured.push_back(pose.is_measured);
  const auto error = evaluate::ate(walk().truth, trajectory_of(slam.map(), slam.frames()),
                                   evaluate::Alignment::kSim3);
  return {is_measured, error ? error->rmse_m : 1e9};
}

TEST(Disturbance, WithoutDepthNothingIsInventedInTheDarkEither) {
  const auto [is_measured, rmse_m] = without_depth(60, 74);
  for (std::size_t i = 60; i <= 74; ++i) EXPECT_FALSE(is_measured[i]) << i;
  EXPECT_GE(std::count(is_measured.begin(), is_measured.end(), true), 95) << "of the 105 in light";
  EXPECT_LT(rmse_m, 0.05);
}

TEST(Disturbance, WithoutDepthAMapThatIsLostBeforeItIsLargeIsGivenUpForANewOne) {
  const auto [is_measured, rmse_m] = without_depth(60, 89);
  for (std::size_t i = 0; i <= 89; ++i) EXPECT_FALSE(is_measured[i]) << i;
  EXPECT_GE(std::count(is_measured.begin(), is_measured.end(), true), 25) << "of the 30 after it";
  EXPECT_LT(rmse_m, 0.05);
}

TEST(Disturbance, WithDepthAMapThatIsLostBeforeItIsLargeIsGivenUpForANewOne) {
  const Outcome outcome =
      outcome_of([](core::Frame frame) { return darkened(std::move(frame), 3, 80); });
  for (std::size_t i = 0; i <= 80; ++i) EXPECT_FALSE(outcome.is_measured[i]) << i;
  for (std::size_t i = 81; i < kNumFrames; ++i) EXPECT_TRUE(outcome.is_measured[i]) << i;
}

TEST(Disturbance, WithDepthAMapThatWasFollowedForAMomentIsGivenUpHoweverLarge) {
  const auto dark = [](core::Frame frame) { return darkened(std::move(frame), 20, 80); };
  Config config = walk_config();
  config.track.initialization.provisional_keyframes = 0;
  const Outcome given_up = outcome_of(dark, kRight_m, config);
  for (std::size_t i = 0; i <= 80; ++i) EXPECT_FALSE(given_up.is_measured[i]) << i;
  for (std::size_t i = 82; i < kNumFrames; ++i) EXPECT_TRUE(given_up.is_measured[i]) << i;
  config.track.initialization.provisional_s = 0.0;
  const Outcome kept = outcome_of(dark, kRight_m, config);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_TRUE(kept.is_measured[i]) << i;
}

TEST(Disturbance, ALensThatIsHalfCoveredLeavesTheOtherHalf) {
  const Outcome outcome = outcome_of([](core::Frame frame) {
    if (is_between(frame, 50, 79)) {
      const cv::Rect covered(0, 0, frame.images[0].cols / 2, frame.images[0].rows);
      frame.images[0](covered).setTo(10);
    }
    return std::optional(frame);
  });
  EXPECT_EQ(outcome.num_measured, kNumFrames);
  EXPECT_EQ(outcome.num_right, kNumFrames);
}

TEST(Disturbance, OneFrameInTenMayBeMissing) {
  core::Random random(3);
  const Outcome outcome = outcome_of([&](core::Frame frame) {
    return random.uniform() < 0.1 ? std::nullopt : std::optional(std::move(frame));
  });
  EXPECT_LT(outcome.num_fed, kNumFrames - 5);
  EXPECT_EQ(outcome.num_measured, outcome.num_fed);
  EXPECT_EQ(outcome.num_right, outcome.num_fed);
}

TEST(Disturbance, ASuddenChangeOfExposureCostsNoPose) {
  const Outcome outcome = outcome_of([](core::Frame frame) {
    if (is_between(frame, 40, 69)) frame.images[0].convertTo(frame.images[0], -1, 0.4, 0.0);
    if (is_between(frame, 70, 99)) frame.images[0].convertTo(frame.images[0], -1, 1.6, 20.0);
    return std::optional(frame);
  });
  EXPECT_EQ(outcome.num_measured, kNumFrames);
  EXPECT_EQ(outcome.num_right, kNumFrames);
}

}  // namespace
}  // namespace samewhere::pipeline
