#pragma once

#include <string_view>

#include <samewhere/core/ids.hpp>
#include <samewhere/core/rigid3.hpp>

namespace samewhere::core {

// States of a session. kWeak: the pose was measured, on less evidence than usual, or its scale is
// suspected to have changed. kLost: no pose. kWaitingFor...: there is no map yet, and this is what
// the frame lacks to begin one: corners; of a camera with depth, depth at them; of one without, a
// second view from elsewhere.
enum class FrameStatus {
  kStarting,
  kTracking,
  kWeak,
  kLost,
  kResumed,
  kWaitingForFeatures,
  kWaitingForDepth,
  kWaitingForParallax
};
constexpr FrameStatus kLastStatus = FrameStatus::kWaitingForParallax;
constexpr bool is_waiting(FrameStatus status) { return status > FrameStatus::kResumed; }

constexpr std::string_view name_of(FrameStatus status) {
  constexpr std::string_view kNames[] = {"starting",
                                         "tracking",
                                         "weak",
                                         "lost",
                                         "resumed",
                                         "waiting for features",
                                         "waiting for depth",
                                         "waiting for parallax"};
  return kNames[static_cast<int>(status)];
}

// Where a frame was seen from, relative to a keyframe: its pose in the world is derived when it is
// asked for, so that a loop that moves the keyframe moves the frame along.
struct FramePose {
  FrameId frame;
  double stamp_s = 0.0;
  FrameStatus status = FrameStatus::kLost;
  bool is_measured = false;  // false: nothing in the image supports the pose (lost)
  KeyframeId reference_keyframe;
  Rigid3 reference_from_frame;  // body of the reference keyframe from body of the frame
  Matrix6d information =
      Matrix6d::Identity();  // of reference_from_frame, order [m; rad], from the drift model
  int num_inliers = 0;
  // Of the reference keyframe, when this was measured (scene/rescale.hpp): who asks later, asks
  // scene::reference_from_frame().
  double log_scale = 0.0;
};

}  // namespace samewhere::core
