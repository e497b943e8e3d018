#include <gtest/gtest.h>

#include <samewhere/pipeline/frame_log.hpp>

namespace samewhere::pipeline {
namespace {

core::FramePose frame_of(const FrameLog& log, core::FrameStatus status) {
  const bool is_measured = status == core::FrameStatus::kTracking;
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

TEST(FrameLog, LastMeasuredSkipsLostFrames) {
  FrameLog log(0);
  EXPECT_EQ(log.last_measured(), nullptr);
  log.add(frame_of(log, core::FrameStatus::kTracking));
  log.add(frame_of(log, core::FrameStatus::kLost));
  ASSERT_NE(log.last_measured(), nullptr);
  EXPECT_EQ(log.last_measured()->frame, core::FrameId(0));
}

TEST(FrameLog, DiscardedPosesAreLostAndSentAgain) {
  FrameLog log(0);
  log.add(frame_of(log, core::FrameStatus::kWaitingForParallax));
  log.add(frame_of(log, core::FrameStatus::kTracking));
  log.take_unsent();
  log.discard_poses();
  EXPECT_EQ(log.last_measured(), nullptr);
  EXPECT_EQ(log.frames()[0].status, core::FrameStatus::kWaitingForParallax);
  EXPECT_EQ(log.frames()[1].status, core::FrameStatus::kLost);
  EXPECT_EQ(log.frames()[1].stamp_s, 1.0);
  EXPECT_EQ(log.num_unsent(), 2U);
}

}  // namespace
}  // namespace samewhere::pipeline
