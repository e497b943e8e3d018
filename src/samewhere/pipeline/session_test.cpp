#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/pipeline/session.hpp>

namespace samewhere::pipeline {
namespace {

using Phase = SessionPhase;
using Status = core::FrameStatus;

TrackedFrame frame_at(double stamp_s, Status status = Status::kTracking) {
  TrackedFrame frame;
  frame.tracked.view.stamp_s = stamp_s;
  frame.tracked.pose.stamp_s = stamp_s;
  frame.tracked.pose.status = status;
  return frame;
}

class SessionStateTest : public testing::Test {
 protected:
  SessionState tracking(DepthFrom depth_from = DepthFrom::kSensor) const {
    SessionState state(config_, depth_from);
    state.initialize(frame_at(0.0, Status::kStarting));
    return state;
  }

  // Tracked until `last_pose_s`, then lost for so many frames.
  SessionState lost(int num_frames, double last_pose_s,
                    DepthFrom depth_from = DepthFrom::kSensor) const {
    SessionState state = tracking(depth_from);
    state.track(frame_at(last_pose_s));
    for (int i = 0; i < num_frames; ++i) state.lose(3);
    return state;
  }

  track::Config config_;
  SessionState::MapAge small_{.num_keyframes = 3, .last_pose_at_s = 1.0};
  SessionState::MapAge large_{.num_keyframes = 1000, .last_pose_at_s = 1.0};
};

TEST_F(SessionStateTest, BeginsWithoutAMap) {
  const SessionState state(config_, DepthFrom::kSensor);
  EXPECT_EQ(state.phase(), Phase::kInitializing);
  EXPECT_EQ(state.last_frame(), nullptr);
  EXPECT_EQ(state.num_reinitializations(), 0);
}

TEST_F(SessionStateTest, BeginsLostInAKnownMap) {
  const SessionState state = SessionState::in_known_map(config_, 12);
  EXPECT_EQ(state.phase(), Phase::kLost);
  EXPECT_EQ(state.tracked_since_keyframe(), 12U);
}

TEST_F(SessionStateTest, TracksOnceInitialized) {
  SessionState state = tracking();
  EXPECT_EQ(state.phase(), Phase::kTracking);
  ASSERT_NE(state.last_frame(), nullptr);
  state.track(frame_at(1.0));
  EXPECT_EQ(state.phase(), Phase::kTracking);
  EXPECT_EQ(state.last_frame()->tracked.pose.stamp_s, 1.0);
  state.track(frame_at(2.0, Status::kWeak));
  EXPECT_EQ(state.phase(), Phase::kWeak);
  EXPECT_EQ(state.num_reinitializations(), 0);
}

TEST_F(SessionStateTest, IsRelocalizedAfterALoss) {
  SessionState state = tracking();
  state.lose(7);
  EXPECT_EQ(state.phase(), Phase::kLost);
  EXPECT_EQ(state.last_frame(), nullptr);
  EXPECT_EQ(state.tracked_since_keyframe(), 7U);
  state.track(frame_at(3.0, Status::kResumed));
  EXPECT_EQ(state.phase(), Phase::kRelocalized);
  state.track(frame_at(3.1));
  EXPECT_EQ(state.phase(), Phase::kTracking);
  EXPECT_EQ(state.tracked_since_keyframe(), 7U);
}

TEST_F(SessionStateTest, AProvisionalSessionIsLostUntilItIsConfirmed) {
  SessionState state = tracking();
  EXPECT_THROW(state.hold(7), core::ContractError) << "it is not lost";
  state.lose(7);
  state.hold(7);
  EXPECT_EQ(state.phase(), Phase::kProvisional);
  EXPECT_TRUE(state.is_lost());
  EXPECT_EQ(state.last_frame(), nullptr) << "nothing is tracked as in a map";
  state.hold(7);
  state.track(frame_at(3.0, Status::kResumed));
  EXPECT_EQ(state.phase(), Phase::kRelocalized);
}

TEST_F(SessionStateTest, ReinitializesOnceAProvisionalRelocalizationIsTakenBack) {
  SessionState state = tracking();
  for (int i = 0; i < config_.relocalization.reinitialize_after_frames; ++i) {
    if (i < 3) {
      state.lose(3);
    } else {
      state.hold(3);
      EXPECT_FALSE(state.may_reinitialize(2.0, small_)) << "frame " << i;
    }
  }
  state.lose(3);
  EXPECT_EQ(state.phase(), Phase::kLost);
  EXPECT_TRUE(state.may_reinitialize(2.0, small_)) << "the frames since the loss count";
}

TEST_F(SessionStateTest, IsReinitializedAfterALoss) {
  SessionState state = tracking();
  state.lose(7);
  state.initialize(frame_at(4.0, Status::kStarting));
  EXPECT_EQ(state.phase(), Phase::kTracking);
  EXPECT_EQ(state.num_reinitializations(), 1);
}

TEST_F(SessionStateTest, RefusesTransitionsThatAStateDoesNotHave) {
  SessionState new_session(config_, DepthFrom::kSensor);
  EXPECT_THROW(new_session.track(frame_at(0.0)), core::ContractError) << "there is no map";
  EXPECT_THROW(new_session.lose(0), core::ContractError) << "there is no map";
  SessionState state = tracking();
  EXPECT_THROW(state.initialize(frame_at(1.0)), core::ContractError) << "it is tracked";
  EXPECT_THROW(state.track(frame_at(1.0, Status::kResumed)), core::ContractError)
      << "it is not lost";
  state.lose(1);
  EXPECT_THROW(state.track(frame_at(1.0)), core::ContractError) << "it has to be relocalized";
  SessionState known = SessionState::in_known_map(config_, 1);
  EXPECT_THROW(known.initialize(frame_at(0.0)), core::ContractError) << "of earlier sessions";
}

TEST_F(SessionStateTest, ReinitializesASmallMapOnlyWhenLost) {
  EXPECT_FALSE(tracking(DepthFrom::kMotion).may_reinitialize(2.0, small_));
  EXPECT_TRUE(lost(1, 1.0, DepthFrom::kMotion).may_reinitialize(2.0, small_));
}

TEST_F(SessionStateTest, WithDepthWaitsForAnOcclusionToEnd) {
  const int wait = config_.relocalization.reinitialize_after_frames;
  EXPECT_FALSE(lost(wait - 1, 1.0).may_reinitialize(2.0, small_));
  EXPECT_TRUE(lost(wait, 1.0).may_reinitialize(2.0, small_));
}

TEST_F(SessionStateTest, WithDepthReinitializesALargeMapThatWasTrackedBriefly) {
  const int wait = config_.relocalization.reinitialize_after_frames;
  EXPECT_TRUE(lost(wait, 1.0).may_reinitialize(2.1, large_)) << "lost for 1.1 s, tracked for 1 s";
  EXPECT_FALSE(lost(wait, 1.0).may_reinitialize(1.9, large_));
  const double long_s = config_.initialization.provisional_s + 1.0;
  large_.last_pose_at_s = long_s;
  EXPECT_FALSE(lost(wait, long_s).may_reinitialize(100.0, large_));
  EXPECT_FALSE(lost(1, 1.0, DepthFrom::kMotion).may_reinitialize(2.1, large_)) << "monocular";
}

TEST_F(SessionStateTest, NeverReinitializesAKnownMap) {
  SessionState state = SessionState::in_known_map(config_, 1);
  for (int i = 0; i < 2 * config_.relocalization.reinitialize_after_frames; ++i) state.lose(1);
  EXPECT_FALSE(state.may_reinitialize(100.0, small_));
}

TEST_F(SessionStateTest, AMapThatIsLostInItsSecondFrameDoesNotWaitAgain) {
  SessionState state = lost(config_.relocalization.reinitialize_after_frames, 1.0);
  state.initialize(frame_at(2.0, Status::kStarting));
  state.lose(4);
  EXPECT_TRUE(state.may_reinitialize(2.1, {.num_keyframes = 1, .last_pose_at_s = 2.0}));
}

}  // namespace
}  // namespace samewhere::pipeline
