#pragma once

#include <optional>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/pipeline/slam.hpp>

namespace samewhere::library {

// The body's pose in two parts (REP-105): a chain of relative poses that no correction moves, and
// where in the map that chain is.
class LivePose {
 public:
  // After each frame that was fed.
  void update(const pipeline::Slam& slam);

  const core::Rigid3& odom_from_body() const { return odom_from_body_; }
  const core::Rigid3& map_from_odom() const { return map_from_odom_; }
  // Of the newest frame, if its pose is provisional.
  const std::optional<core::Rigid3>& provisional() const { return provisional_; }
  // Of the last frame with a confirmed pose.
  const std::optional<double>& last_pose_s() const { return last_pose_s_; }

 private:
  core::Rigid3 odom_from_body_;
  core::Rigid3 map_from_odom_;
  core::Rigid3 last_motion_;  // from frame to frame
  std::optional<core::Rigid3> provisional_;
  std::optional<double> last_pose_s_;
};

}  // namespace samewhere::library
