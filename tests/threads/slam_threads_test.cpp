// SLAM on three threads gives the same bytes as on one, and ends without a deadlock. A camera moves
// along a painted wall and back; nothing is rendered, so that the sanitizers take little time.
#include <algorithm>
#include <chrono>
#include <deque>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <unistd.h>

#include "wall_walk.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/pipeline/slam_test_hooks.hpp>
#include <samewhere/report/frames.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/run/map_saver.hpp>

namespace samewhere::pipeline {
namespace {

// The same path along two walls, the lower one nearer, for a camera without depth: the homography
// of one plane alone is ambiguous.
std::vector<core::Frame> walk_without_depth() {
  const cv::Mat wall = painted_wall();
  const cv::Rect lower(0, kHeight_px / 2, kWidth_px, kHeight_px / 2);
  std::vector<core::Frame> frames = walk();
  for (auto& frame : frames) {
    const auto position =
        static_cast<int>(std::min(frame.id.index(), kNumFrames - frame.id.index()));
    frame.depth_m.reset();
    if (position * kStep_px * 3 / 2 + kWidth_px > wall.cols) continue;
    const cv::Rect nearer = lower + cv::Point(position * kStep_px * 3 / 2, 0);
    frame.images[0] = frame.images[0].clone();
    wall(nearer).copyTo(frame.images[0](lower));
  }
  return frames;
}

// All results of a run, as the bytes that are written.
struct Found {
  std::string trajectory;
  std::string loops;
  std::string map;  // the file
  std::size_t num_loops = 0;
  std::size_t num_keyframes = 0;
  std::ptrdiff_t num_searches = 0;  // views of the map that the lost frame was compared with
};

Found found_by(const std::vector<core::Frame>& frames, const Config& config,
               const core::StageHook& hook = {}, DepthFrom depth_from = DepthFrom::kSensor) {
  const auto path = std::filesystem::path(testing::TempDir()) /
                    ("samewhere_slam_threads_" + std::to_string(getpid()) + ".sw");
  std::filesystem::remove(path);
  std::optional<run::MapSaver> saver;
  Slam slam(config, depth_from,
            SlamTestHooks{
                .keep_map = [&](const auto& map, const MapNews& news) { saver->save(map, news); },
                .before_message = hook});
  saver.emplace(path, config, slam.describer_checksum());
  for (const auto& frame : frames) slam.feed(frame);
  slam.finish();
  EXPECT_FALSE(saver->error()) << *saver->error();
  saver.reset();
  std::ostringstream trajectory;
  trajectory << core::tum_text(trajectory_of(slam.map(), slam.frames()));
  Found found{trajectory.str(),
              report::loops_json(slam.ledger()),
              core::read_file(path),
              slam.map().loops.size(),
              slam.map().keyframes.size(),
              std::count_if(slam.ledger().begin(), slam.ledger().end(), [](const auto& row) {
                return row.candidate.query == core::FrameId(kLastBlackFrame);
              })};
  std::filesystem::remove(path);
  return found;
}

void expect_same(const Found& found, const Found& expected, const std::string& how) {
  EXPECT_EQ(found.trajectory, expected.trajectory) << how;
  EXPECT_EQ(found.loops, expected.loops) << how;
  EXPECT_TRUE(found.map == expected.map) << how << ": the map files differ";
}

// Sleeps for up to 30 ms at each message; the seed determines how long.
core::StageHook asleep(std::uint64_t seed) {
  return [seed](std::uint64_t number) {
    core::Random random(core::seed_of(seed, "dawdle", number));
    std::this_thread::sleep_for(std::chrono::milliseconds(random.index(31)));
  };
}

// Threads that only use processor time.
class Load {
 public:
  explicit Load(int num_threads) {
    for (int i = 0; i < num_threads; ++i) {
      threads_.emplace_back([this] {
        while (!is_over_) {
        }
      });
    }
  }
  Load(const Load&) = delete;
  Load& operator=(const Load&) = delete;
  ~Load() {
    is_over_ = true;
    for (auto& thread : threads_) thread.join();
  }

 private:
  std::atomic<bool> is_over_ = false;
  std::deque<std::thread> threads_;
};

TEST(SlamThreads, ResultsEqualThoseOfOneThreadForAnyDelay) {
  const std::vector<core::Frame> frames = walk();
  const Found in_turn = found_by(frames, config_of(false));
  EXPECT_GT(in_turn.num_loops, 0U) << "a loop must be closed";
  EXPECT_GT(in_turn.num_keyframes, 5U);
  EXPECT_GT(in_turn.num_searches, 0) << "tracking must be lost";
  expect_same(found_by(frames, config_of(false)), in_turn, "in turn, once more");
  expect_same(found_by(frames, config_of(true)), in_turn, "in threads");
  for (std::uint64_t seed = 0; seed < 2; ++seed) {
    expect_same(found_by(frames, config_of(true), asleep(seed)), in_turn,
                "asleep, seed " + std::to_string(seed));
  }
  const Load load(4);
  expect_same(found_by(frames, config_of(true)), in_turn, "under load");
  expect_same(found_by(frames, config_of(true), asleep(9)), in_turn, "under load and asleep");
}

TEST(SlamThreads, LagAndDelayChangeTheResultIndependentlyOfThreads) {
  const std::vector<core::Frame> frames = walk();
  Config in_turn = config_of(false);
  in_turn.map.visible_after_frames = 5;
  in_turn.map.loop_lag_keyframes = 3;
  Config in_threads = in_turn;
  in_threads.threads = true;
  const Found expected = found_by(frames, in_turn);
  EXPECT_NE(expected.trajectory, found_by(frames, config_of(false)).trajectory);
  expect_same(found_by(frames, in_threads, asleep(1)), expected, "asleep");
}

// A loop starts it; no other loop follows for a while, so that its result is applied.
TEST(SlamThreads, FullBundleAdjustmentDuringTheRunIsIndependentOfThreads) {
  const std::vector<core::Frame> frames = walk();
  Config in_turn = config_of(false);
  in_turn.verify.pause_frames = 12;
  in_turn.map.full_bundle_after_keyframes = 1;
  in_turn.map.full_bundle_pace = 10'000'000;
  Config at_the_end = in_turn;
  at_the_end.map.full_bundle_after_keyframes = 10'000;
  Config in_threads = in_turn;
  in_threads.threads = true;
  const Found expected = found_by(frames, in_turn);
  EXPECT_NE(expected.trajectory, found_by(frames, at_the_end).trajectory) << "none during the run";
  expect_same(found_by(frames, in_threads), expected, "in threads");
  for (std::uint64_t seed = 0; seed < 2; ++seed)
    expect_same(found_by(frames, in_threads, asleep(seed)), expected, "asleep");
}

TEST(SlamThreads, WithoutDepthResultsEqualThoseOfOneThread) {
  const std::vector<core::Frame> frames = walk_without_depth();
  const Found in_turn = found_by(frames, config_of(false), {}, DepthFrom::kMotion);
  EXPECT_GT(in_turn.num_keyframes, 3U) << "the map was not initialized";
  expect_same(found_by(frames, config_of(true), {}, DepthFrom::kMotion), in_turn, "in threads");
  expect_same(found_by(frames, config_of(true), asleep(3), DepthFrom::kMotion), in_turn, "asleep");
}

// A later session in the map of the first third of the path, as poses with status and ledger.
std::string found_in_known_map(const scene::StoredMap& known, const Config& config,
                               const core::StageHook& hook = {}) {
  Slam slam(config, known, Slam::Use::kExtend, SlamTestHooks{.before_message = hook});
  std::uint64_t number = 0;
  for (core::Frame frame : walk()) {
    frame.id = core::FrameId(number++, slam.session());
    slam.feed(frame);
  }
  slam.finish();
  const bool has_grown = slam.map().keyframes.size() > known.map.keyframes.size();
  EXPECT_EQ(has_grown, config.verify.prior == verify::Prior::kUnique)
      << "the camera was not relocalized, or not provisionally";
  std::vector<report::FrameRecord> frames;
  for (const core::FramePose& pose : slam.frames()) {
    frames.push_back({pose, {}, std::nullopt});
    if (pose.is_measured) frames.back().world_from_camera = world_from_camera(slam.map(), pose);
  }
  return report::frames_csv(frames) + report::loops_json(slam.ledger());
}

TEST(SlamThreads, InAKnownMapResultsEqualThoseOfOneThread) {
  const std::vector<core::Frame> frames = walk();
  Slam first(config_of(false));
  for (std::size_t i = 0; i < frames.size() / 3; ++i) first.feed(frames[i]);
  first.finish();
  const scene::StoredMap known{
      first.map(), {.frames = first.frames(), .descriptors = first.descriptors(), .ledger = {}}};
  for (const auto prior : {verify::Prior::kRepetitive, verify::Prior::kUnique}) {
    Config in_turn = config_of(false);
    Config in_threads = config_of(true);
    in_turn.verify.prior = in_threads.verify.prior = prior;
    const std::string expected = found_in_known_map(known, in_turn);
    EXPECT_EQ(found_in_known_map(known, in_threads), expected);
    EXPECT_EQ(found_in_known_map(known, in_threads, asleep(4)), expected);
  }
}

void run_to_the_end(const std::vector<core::Frame>& frames, const SlamTestHooks& hooks) {
  Slam slam(config_of(true), DepthFrom::kSensor, hooks);
  for (const auto& frame : frames) slam.feed(frame);
  slam.finish();
}

TEST(SlamThreads, AnExceptionInAStageIsRethrownWithoutDeadlock) {
  const std::vector<core::Frame> frames = walk();
  for (const int num_kept : {0, 1, 4}) {
    int count = 0;
    const KeepMap fail = [&](const scene::MapVersion&, const MapNews&) {
      if (count++ == num_kept) throw core::InputError("no room on the disk");
    };
    EXPECT_THROW(run_to_the_end(frames, {.keep_map = fail}), core::InputError) << num_kept;
  }
  Slam broken(
      config_of(false), DepthFrom::kSensor,
      SlamTestHooks{.keep_map = [](const auto&, const auto&) { throw core::InputError("no room"); },
                    .before_message = {}});
  EXPECT_THROW(broken.feed(frames[0]), core::InputError);
  EXPECT_THROW(broken.feed(frames[1]), core::ContractError)
      << "no frame is accepted after an error";
  // message by message, in mapping or in loop closing
  for (const std::uint64_t last : {0, 1, 2, 3, 8}) {
    const core::StageHook fail = [last](std::uint64_t number) {
      if (number == last) throw std::runtime_error("broken");
    };
    EXPECT_THROW(run_to_the_end(frames, {.before_message = fail}), std::runtime_error) << last;
  }
}

TEST(SlamThreads, DestructionDuringWorkEnds) {
  const std::vector<core::Frame> frames = walk();
  for (const std::size_t num_frames : {0, 1, 2, 7, 20}) {
    Slam slam(config_of(true), DepthFrom::kSensor,
              SlamTestHooks{.before_message = asleep(num_frames)});
    for (std::size_t i = 0; i < num_frames; ++i) slam.feed(frames[i]);
  }
}

TEST(SlamThreads, MapAndLedgerAreAvailableAfterFinish) {
  Slam slam(config_of(true));
  EXPECT_THROW(slam.map(), core::ContractError);
  slam.finish();
  EXPECT_TRUE(slam.map().keyframes.empty());
  EXPECT_TRUE(slam.ledger().empty());
  EXPECT_THROW(slam.finish(), core::ContractError);
}

}  // namespace
}  // namespace samewhere::pipeline
