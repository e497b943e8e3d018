#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/channel.hpp>
#include <samewhere/core/stage_thread.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/library/test_walk.hpp>
#include <samewhere/run/run.hpp>
#include <samewhere/slam.hpp>

namespace samewhere::library {
namespace {

using testing::HasSubstr;

Options options_of(bool threads) { return {.settings = test_settings(), .threads = threads}; }

struct Session {
  std::vector<Tracked> tracked;
  std::vector<Event> events;
  std::vector<StampedPose> trajectory;
};

void track_all(Slam& slam, Session& session, const TestWalk& walk = test_walk()) {
  for (std::size_t i = 0; i < walk.frames.size(); ++i) {
    session.tracked.push_back(slam.track(walk.at(i)));
    for (Event& event : slam.take_events()) session.events.push_back(std::move(event));
  }
}

Session finished_session(const Options& options) {
  Slam slam(test_walk().calibration, options);
  Session session;
  track_all(slam, session);
  slam.finish();
  for (Event& event : slam.take_events()) session.events.push_back(std::move(event));
  session.trajectory = slam.trajectory();
  return session;
}

template <class What>
std::vector<What> of_kind(const std::vector<Event>& events) {
  std::vector<What> found;
  for (const Event& event : events)
    if (const auto* what = std::get_if<What>(&event.what)) found.push_back(*what);
  return found;
}

std::multiset<std::string> texts(const std::vector<LoopVerdict>& verdicts) {
  std::multiset<std::string> lines;
  for (const LoopVerdict& verdict : verdicts) {
    lines.insert(std::to_string(verdict.candidate) + " " + std::to_string(verdict.query.index) +
                 " " + std::to_string(verdict.match.index) + " " + verdict.check + " " +
                 verdict.reason);
  }
  return lines;
}

class LiveSlam : public testing::TestWithParam<bool> {};

void expect_bits_of_run(int num_frames, bool threads) {
  const pipeline::Config config = test_config(num_frames);
  const run::RunOutcome run = run::run_slam(run::open_source(config), config, {}, true);
  const TestWalk walk = read_walk(config);
  Slam slam(walk.calibration, options_of(threads));
  Session session;
  track_all(slam, session, walk);
  slam.finish();
  for (Event& event : slam.take_events()) session.events.push_back(std::move(event));
  session.trajectory = slam.trajectory();
  std::size_t num_poses = 0;
  for (const report::FrameRecord& frame : run.record.frames) {
    if (!frame.world_from_camera) continue;
    ASSERT_LT(num_poses, session.trajectory.size());
    const StampedPose& pose = session.trajectory[num_poses++];
    EXPECT_EQ(pose.stamp_s, frame.pose.stamp_s);
    EXPECT_EQ(pose.map_from_camera.matrix(), pose_of(*frame.world_from_camera).matrix());
  }
  EXPECT_EQ(num_poses, session.trajectory.size());
  EXPECT_EQ(num_poses, walk.frames.size());
  std::vector<LoopVerdict> of_run;
  for (const core::LedgerRow& row : run.record.ledger) of_run.push_back(verdict_of(row));
  EXPECT_FALSE(of_run.empty());
  EXPECT_EQ(texts(of_kind<LoopVerdict>(session.events)), texts(of_run));
}

TEST_P(LiveSlam, GivesThePosesAndVerdictsOfARunToTheBit) { expect_bits_of_run(40, GetParam()); }

// The last frames are keyframes whose map was not visible to any frame.
TEST(LiveSlam, TellsTheVerdictsOnTheLastKeyframeAtTheEnd) {
  for (const int num_frames : {35, 36, 37}) expect_bits_of_run(num_frames, false);
}

INSTANTIATE_TEST_SUITE_P(InOneThreadAndInSeveral, LiveSlam, testing::Bool());

TEST(LiveSlam, TwoSessionsGiveTheSamePosesAndEventsAtTheSameFrames) {
  const Session one = finished_session(options_of(true));
  const Session other = finished_session(options_of(false));
  ASSERT_EQ(one.tracked.size(), other.tracked.size());
  for (std::size_t i = 0; i < one.tracked.size(); ++i) {
    EXPECT_EQ(one.tracked[i].odom_from_camera.matrix(), other.tracked[i].odom_from_camera.matrix());
    EXPECT_EQ(one.tracked[i].map_from_odom.matrix(), other.tracked[i].map_from_odom.matrix());
    EXPECT_EQ(one.tracked[i].map_version, other.tracked[i].map_version);
  }
  ASSERT_EQ(one.events.size(), other.events.size());
  for (std::size_t i = 0; i < one.events.size(); ++i) {
    EXPECT_EQ(one.events[i].frame, other.events[i].frame);
    EXPECT_EQ(one.events[i].what.index(), other.events[i].what.index());
  }
}

TEST(LiveSlam, OdometryDoesNotJumpWhereALoopCorrectsTheMap) {
  const Session session = finished_session(options_of(true));
  const auto corrections = of_kind<MapCorrected>(session.events);
  ASSERT_FALSE(corrections.empty()) << "without a correction this shows nothing";
  constexpr double kTolerance_m = 0.03;
  double jump_of_map_m = 0.0;
  for (std::size_t i = 1; i < session.tracked.size(); ++i) {
    const Tracked& now = session.tracked[i];
    const Tracked& before = session.tracked[i - 1];
    const Pose step = before.odom_from_camera.inverse() * now.odom_from_camera;
    const core::Rigid3 true_step = inverse(test_walk().truth[i - 1].world_from_camera) *
                                   test_walk().truth[i].world_from_camera;
    EXPECT_LT((step.translation() - true_step.translation).norm(), kTolerance_m) << "frame " << i;
    jump_of_map_m = std::max(
        jump_of_map_m, (now.map_from_odom.inverse() * before.map_from_odom).translation().norm());
    EXPECT_NEAR(
        (session.trajectory[i].map_from_camera.translation() - now.map_from_camera().translation())
            .norm(),
        0.0, kTolerance_m)
        << "frame " << i;
  }
  EXPECT_GT(jump_of_map_m, 0.0);
}

TEST(LiveSlam, EventsTellKeyframesInTheOrderOfTheMap) {
  Slam slam(test_walk().calibration, options_of(true));
  Session session;
  track_all(slam, session);
  slam.finish();
  for (Event& event : slam.take_events()) session.events.push_back(std::move(event));
  const auto inserted = of_kind<KeyframeInserted>(session.events);
  const auto keyframes = slam.map()->keyframes();
  ASSERT_EQ(inserted.size(), keyframes.size());
  ASSERT_GT(inserted.size(), 3U);
  for (std::size_t i = 0; i < inserted.size(); ++i) {
    EXPECT_EQ(inserted[i].keyframe, keyframes[i].id);
    EXPECT_EQ(inserted[i].frame, keyframes[i].frame);
  }
}

TEST(LiveSlam, EventsGoToTheCallbackInstead) {
  std::vector<Event> heard;
  Options options = options_of(true);
  options.on_event = [&](const Event& event) { heard.push_back(event); };
  const Session session = finished_session(options);
  EXPECT_TRUE(session.events.empty());
  EXPECT_FALSE(of_kind<KeyframeInserted>(heard).empty());
  EXPECT_FALSE(of_kind<LoopVerdict>(heard).empty());
}

TEST(LiveSlam, AnotherThreadReadsSnapshotsWhileFramesAreTracked) {
  Slam slam(test_walk().calibration, options_of(true));
  core::Guarded<bool> is_over{false};
  std::uint64_t last_version = 0;
  std::size_t num_read = 0;
  core::WorkerThread reader([&] {
    while (!is_over.get()) {
      const std::shared_ptr<const Map> map = slam.map();
      EXPECT_GE(map->version(), last_version);
      last_version = map->version();
      EXPECT_EQ(map->keyframes().size(), map->num_keyframes());
      for (const Map::Landmark& landmark : map->landmarks())
        EXPECT_TRUE(landmark.in_map.allFinite());
      ++num_read;
    }
  });
  Session session;
  track_all(slam, session);
  slam.finish();
  is_over.set(true);
  reader.join();
  EXPECT_GT(num_read, 0U);
  const Session alone = finished_session(options_of(true));
  ASSERT_EQ(alone.trajectory.size(), slam.trajectory().size());
  EXPECT_EQ(alone.trajectory.back().map_from_camera.matrix(),
            slam.trajectory().back().map_from_camera.matrix());
}

TEST(LiveSlam, ASnapshotStaysAsItIs) {
  Slam slam(test_walk().calibration, options_of(true));
  for (std::size_t i = 0; i < 10; ++i) slam.track(test_walk().at(i));
  const auto early = slam.map();
  const std::uint64_t version = early->version();
  const auto landmarks = early->landmarks();
  for (std::size_t i = 10; i < test_walk().frames.size(); ++i) slam.track(test_walk().at(i));
  EXPECT_GT(slam.map()->version(), version);
  EXPECT_EQ(early->version(), version);
  const auto again = early->landmarks();
  ASSERT_EQ(again.size(), landmarks.size());
  for (std::size_t i = 0; i < again.size(); ++i) EXPECT_EQ(again[i].in_map, landmarks[i].in_map);
}

TEST(LiveSlam, NeverWaitTracksTheWalkToo) {
  Options options = options_of(true);
  options.never_wait = true;
  const Session session = finished_session(options);
  ASSERT_EQ(session.tracked.size(), test_walk().frames.size());
  for (const Tracked& tracked : session.tracked)
    EXPECT_TRUE(tracked.has_pose()) << "frame " << tracked.frame;
  EXPECT_FALSE(of_kind<KeyframeInserted>(session.events).empty());
}

TEST(LiveSlam, NoKeyframeComesWhileMappingIsPaused) {
  Slam slam(test_walk().calibration, options_of(true));
  for (std::size_t i = 0; i < 10; ++i) slam.track(test_walk().at(i));
  slam.pause_mapping();
  slam.track(test_walk().at(10));
  slam.track(test_walk().at(11));  // a keyframe in progress is visible by now
  slam.track(test_walk().at(12));
  const std::size_t num_before = slam.map()->num_keyframes();
  for (std::size_t i = 13; i < 25; ++i) slam.track(test_walk().at(i));
  EXPECT_EQ(slam.map()->num_keyframes(), num_before);
  slam.resume_mapping();
  for (std::size_t i = 25; i < test_walk().frames.size(); ++i) slam.track(test_walk().at(i));
  EXPECT_GT(slam.map()->num_keyframes(), num_before);
}

TEST(LiveSlam, ASavedMapIsLocalizedIn) {
  const input::TestFolder folder;
  Slam slam(test_walk().calibration, options_of(true));
  for (std::size_t i = 0; i < 30; ++i) slam.track(test_walk().at(i));
  slam.finish();
  slam.save(folder.root() / "saved.sw");
  EXPECT_THROW(slam.save(folder.root() / "saved.sw"), InputError) << "it is there already";
  Options options = options_of(true);
  options.map = folder.root() / "saved.sw";
  options.map_use = MapUse::kLocalize;
  options.prior = Prior::kUnique;
  Slam localizer(test_walk().calibration, options);
  const std::size_t num_keyframes = localizer.map()->num_keyframes();
  EXPECT_EQ(num_keyframes, slam.map()->num_keyframes());
  Tracked last;
  for (std::size_t i = 10; i < 25; ++i) last = localizer.track(test_walk().at(i));
  ASSERT_TRUE(last.has_pose());
  EXPECT_LT(
      (last.map_from_camera().translation() - slam.trajectory()[24].map_from_camera.translation())
          .norm(),
      0.05);
  EXPECT_EQ(localizer.map()->num_keyframes(), num_keyframes);
  const auto steps = of_kind<Relocalized>(localizer.take_events());
  ASSERT_FALSE(steps.empty());
  EXPECT_EQ(steps.back().step, RelocalizationStep::kConfirmed);
  EXPECT_THROW(localizer.save(folder.root() / "other.sw"), UsageError);
}

TEST(LiveSlam, ResetAndLoadBeginAnotherSession) {
  const input::TestFolder folder;
  Options options = options_of(true);
  options.save_to = folder.root() / "grown.sw";
  Slam slam(test_walk().calibration, options);
  for (std::size_t i = 0; i < 12; ++i) slam.track(test_walk().at(i));
  slam.finish();
  slam.reset();
  EXPECT_EQ(slam.map()->num_keyframes(), 0U);
  EXPECT_EQ(slam.track(test_walk().at(0)).frame, 0U);
  EXPECT_THROW(slam.load(folder.root() / "none.sw", MapUse::kExtend), InputError);
  EXPECT_EQ(slam.track(test_walk().at(1)).frame, 1U) << "the session goes on";
  slam.load(folder.root() / "grown.sw", MapUse::kLocalize);
  EXPECT_GT(slam.map()->num_keyframes(), 1U);
  EXPECT_EQ(slam.track(test_walk().at(0)).frame, 0U);
}

// The last frame before the gap is a keyframe whose map is not yet visible.
TEST(LiveSlam, AGapAfterAnyFrameIsNoError) {
  for (std::size_t last = 2; last < 14; ++last) {
    Slam slam(test_walk().calibration, options_of(false));
    for (std::size_t i = 0; i <= last; ++i) slam.track(test_walk().at(i));
    for (std::size_t i = last + 1; i < last + 4; ++i) {
      Frame frame = test_walk().at(i);
      frame.stamp_s += 2.0;
      EXPECT_NO_THROW(slam.track(frame)) << "gap after frame " << last;
    }
  }
}

}  // namespace
}  // namespace samewhere::library
