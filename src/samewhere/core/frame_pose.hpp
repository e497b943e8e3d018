#pragma once

#include <string_view>

#include <samewhere/core/ids.hpp>
#include <samewhere/core/rigid3.hpp>

namespace samewhere::core {

// Tracking status. kWeak: the pose was measured with few inliers, or scale drift is suspected.
// kLost: no pose. kWaitingFor...: not initialized, and what initialization lacks: features; with
// depth, depth at them; without, a second view with parallax. kResumed: relocalized, confirmed.
// kProvisional: the pose belongs to a relocalization that is not confirmed: it may be in a
// look-alike place.
enum class FrameStatus {
  kStarting,
  kTracking,
  kWeak,
  kLost,
  kResumed,
  kWaitingForFeatures,
  kWaitingForDepth,
  kWaitingForParallax,
  kProvisional
};
constexpr FrameStatus kLastStatus = FrameStatus::kProvisional;
constexpr bool is_waiting(FrameStatus status) {
  return status > FrameStatus::kResumed && status < FrameStatus::kProvisional;
}

constexpr std::string_view name_of(FrameStatus status) {
  constexpr std::string_view kNames[] = {"initializing",
                                         "tracking",
                                         "weak",
                                         "lost",
                                         "relocalized",
                                         "waiting for features",
                                         "waiting for depth",
                                         "waiting for parallax",
                                         "provisional"};
  return kNames[static_cast<int>(status)];
}

// Pose of a frame relative to a keyframe. The pose in the world is derived on demand, so that a
// loop closure that moves the keyframe moves the frame as well.
struct FramePose {
  FrameId frame;
  double stamp_s = 0.0;
  FrameStatus status = FrameStatus::kLost;
  bool is_measured = false;  // false: no pose (lost)
  KeyframeId reference_keyframe;
  Rigid3 reference_from_frame;  // body of the reference keyframe from body of the frame
  Matrix6d information =
      Matrix6d::Identity();  // of reference_from_frame, order [m; rad], from the drift model
  int num_inliers = 0;
  // Of the reference keyframe, when this was measured (scene/rescale.hpp); later readers call
  // scene::reference_from_frame().
  double log_scale = 0.0;
};

// Whether the frame has a pose that is not provisional.
inline bool is_confirmed(const FramePose& pose) {
  return pose.is_measured && pose.status != FrameStatus::kProvisional;
}

}  // namespace samewhere::core
