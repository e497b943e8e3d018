#include <gtest/gtest.h>

#include <samewhere/pipeline/frame_log.hpp>

namespace samewhere::pipeline {
namespace {

core::FramePose frame_of(const FrameLog& log, core::FrameStatus status) {
  const bool is_measured =
      status == core::FrameStatus::kTracking || status == core::FrameStatus::kProvisional;
  return {.frame = log.next_id(),
          .stamp_s = static_cast<double>(log.size()),
          .status = status,
          .is_measured = is_measured};
}

TEST(FrameLog, NumbersFramesInTheSession) {
  FrameLog log(3);
  EXPECT_EQ(log.next_id(), core::FrameId(0, 3));
  log.add(frame_of(log, core::FrameStatus::kTracking));
  EXPECT_EQ(log.next_id(), core::FrameId(1, 3));
}

TEST(FrameLog, SendsEachFrameOnce) {
  FrameLog log(0);
  log.add(frame_of(log, core::FrameStatus::kTracking));
  log.add(frame_of(log, core::FrameStatus::kLost));
  EXPECT_EQ(log.num_unsent(), 2U);
  EXPECT_EQ(log.take_unsent().size(), 2U);
  EXPECT_TRUE(log.take_unsent().empty());
  log.add(frame_of(log, core::FrameStatus::kTracking));
  EXPECT_EQ(log.take_unsent().front().frame, core::FrameId(2));
}

TEST(FrameLog, LastConfirmedSkipsLostFrames) {
  FrameLog log(0);
  EXPECT_EQ(log.last_confirmed(), nullptr);
  log.add(frame_of(log, core::FrameStatus::kTracking));
  log.add(frame_of(log, core::FrameStatus::kLost));
  ASSERT_NE(log.last_confirmed(), nullptr);
  EXPECT_EQ(log.last_confirmed()->frame, core::FrameId(0));
}

// A tracked frame, sent; then two provisional ones around a lost one.
FrameLog log_with_provisional() {
  FrameLog log(0);
  log.add(frame_of(log, core::FrameStatus::kTracking));
  log.take_unsent();
  for (const auto status :
       {core::FrameStatus::kProvisional, core::FrameStatus::kLost, core::FrameStatus::kProvisional})
    log.add(frame_of(log, status));
  log.newest().num_inliers = 100;
  return log;
}

TEST(FrameLog, ProvisionalFramesAreNotConfirmed) {
  FrameLog log = log_with_provisional();
  ASSERT_NE(log.last_confirmed(), nullptr);
  EXPECT_EQ(log.last_confirmed()->frame, core::FrameId(0));
  EXPECT_EQ(log.before(log.frames()[2]), nullptr) << "the frame before is provisional";
  ASSERT_NE(log.before(log.frames()[1]), nullptr);
  EXPECT_EQ(log.before(log.frames()[0]), nullptr) << "there is none";
}

TEST(FrameLog, ConfirmedFramesKeepTheirPoses) {
  FrameLog log = log_with_provisional();
  log.confirm_provisional(40);
  EXPECT_EQ(log.frames()[1].status, core::FrameStatus::kWeak) << "few inliers";
  EXPECT_EQ(log.frames()[2].status, core::FrameStatus::kLost);
  EXPECT_EQ(log.frames()[3].status, core::FrameStatus::kTracking);
  EXPECT_EQ(log.last_confirmed()->frame, core::FrameId(3));
}

TEST(FrameLog, FramesThatAreTakenBackLoseTheirPoses) {
  FrameLog log = log_with_provisional();
  log.take_back_provisional();
  for (std::size_t i = 1; i < log.size(); ++i) {
    EXPECT_EQ(log.frames()[i].status, core::FrameStatus::kLost) << "frame " << i;
    EXPECT_FALSE(log.frames()[i].is_measured) << "frame " << i;
  }
  EXPECT_EQ(log.last_confirmed()->frame, core::FrameId(0)) << "of before the loss";
}

TEST(FrameLog, MovesProvisionalFramesOnly) {
  FrameLog log = log_with_provisional();
  int num_moved = 0;
  log.move_provisional([&](core::FramePose pose) {
    ++num_moved;
    pose.reference_keyframe = core::KeyframeId(7);
    return pose;
  });
  EXPECT_EQ(num_moved, 2);
  EXPECT_EQ(log.frames()[3].reference_keyframe, core::KeyframeId(7));
  EXPECT_FALSE(log.frames()[0].reference_keyframe.is_valid());
}

TEST(FrameLog, DiscardedPosesAreLostAndSentAgain) {
  FrameLog log(0);
  log.add(frame_of(log, core::FrameStatus::kWaitingForParallax));
  log.add(frame_of(log, core::FrameStatus::kTracking));
  log.take_unsent();
  log.discard_poses();
  EXPECT_EQ(log.last_confirmed(), nullptr);
  EXPECT_EQ(log.frames()[0].status, core::FrameStatus::kWaitingForParallax);
  EXPECT_EQ(log.frames()[1].status, core::FrameStatus::kLost);
  EXPECT_EQ(log.frames()[1].stamp_s, 1.0);
  EXPECT_EQ(log.num_unsent(), 2U);
}

}  // namespace
}  // namespace samewhere::pipeline
