// The live interface with threads: snapshots in a second thread, and frames that do not wait.
#include <chrono>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "wall_walk.hpp"
#include <samewhere/core/channel.hpp>
#include <samewhere/library/test_walk.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/pipeline/slam_test_hooks.hpp>
#include <samewhere/slam.hpp>

namespace samewhere::pipeline {
namespace {

std::unique_ptr<samewhere::Slam> live_slam(const core::Frame& frame) {
  Calibration calibration{.has_depth = true, .frame_rate_hz = 10.0};
  calibration.cameras.push_back(library::camera_of(frame.rig->cameras[0], kWidth_px, kHeight_px));
  Options options;
  options.settings = {"features.num_features=300", "map.min_tracked=60", "retrieve.window_frames=4",
                      "map.min_shared=1000", "input.enlarge=false"};
  return std::make_unique<samewhere::Slam>(calibration, options);
}

TEST(LiveSlamInThreads, ASecondThreadReadsSnapshotsAndEvents) {
  const auto frames = walk();
  const auto slam = live_slam(frames[0]);
  core::Guarded<bool> is_over{false};
  std::size_t num_landmarks = 0;
  std::size_t num_events = 0;
  std::thread reader([&] {
    while (!is_over.get()) {
      const auto map = slam->map();
      num_landmarks = std::max(num_landmarks, map->landmarks().size());
      EXPECT_EQ(map->keyframes().size(), map->num_keyframes());
      EXPECT_LE(map->loops().size(), map->num_keyframes() * map->num_keyframes());
      num_events += slam->take_events().size();
    }
  });
  for (const core::Frame& frame : frames) {
    slam->track({.stamp_s = frame.stamp_s,
                 .images = {library::TestWalk::view_of(frame.images[0], PixelFormat::kBgr8)},
                 .depth = library::TestWalk::view_of(*frame.depth_m, PixelFormat::kDepthFloat)});
  }
  slam->finish();
  is_over.set(true);
  reader.join();
  num_events += slam->take_events().size();
  EXPECT_GT(slam->map()->landmarks().size(), 0U);
  EXPECT_GE(num_events, slam->map()->num_keyframes());
}

// Mapping is held until all of these frames have been fed.
TEST(LiveSlamInThreads, FramesDoNotWaitForALateStage) {
  constexpr std::size_t kNumHeld = 12;
  constexpr double kGiveUp_s = 30.0;
  constexpr std::uint64_t kFirstHeld = 2;  // after the message that begins the map, and its answer
  core::Channel<int> gate(1);
  core::Guarded<bool> was_waited_for{false};
  SlamTestHooks hooks;
  hooks.before_message = [&](std::uint64_t number) {
    if (number >= kFirstHeld && gate.is_open_for(kGiveUp_s)) was_waited_for.set(true);
  };
  Slam slam(config_of(true), DepthFrom::kSensor, hooks);
  slam.never_wait();
  const auto frames = walk();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i == kNumHeld) gate.close();
    slam.feed(frames[i]);
    if (i < kNumHeld) {
      EXPECT_TRUE(slam.newest().pose) << "frame " << i;
      EXPECT_EQ(slam.visible_map().keyframes.size(), 1U) << "what mapping is held from";
    }
  }
  slam.finish();
  EXPECT_FALSE(was_waited_for.get()) << "feed() waited for mapping";
  EXPECT_GT(slam.map().keyframes.size(), 1U);
}

}  // namespace
}  // namespace samewhere::pipeline
