#pragma once

#include <deque>
#include <optional>

#include <samewhere/slam.hpp>
#include <samewhere/types.hpp>

namespace samewhere::node {

// Poses of the robot's base by odometry from elsewhere, the newest thousand.
class OdometryBuffer {
 public:
  // One that is not newer than the last is left out; a step back by more than a second begins
  // again.
  void add(double stamp_s, const Pose& odom_from_base);
  bool is_empty() const { return poses_.empty(); }
  // Interpolated. Nothing before the first and after the last.
  std::optional<Pose> at(double stamp_s) const;

 private:
  struct StampedOdometry {
    double stamp_s = 0.0;
    Pose odom_from_base = Pose::Identity();
  };
  std::deque<StampedOdometry> poses_;
};

// The chain map <- odom <- base (REP-105). map_from_odom * odom_from_base is the pose of the base
// in the map; odom_from_base never jumps, also where a session ends and another begins.
class LiveFrames {
 public:
  // The next frame is the first of a session, whose odometry begins at its own origin.
  void begin_session() { is_new_session_ = true; }
  void update(const Tracked& tracked, const Pose& camera_from_base);
  // With odometry from elsewhere at the stamp of that frame: map_from_odom follows from it.
  void use_odometry(const Pose& odom_from_base);

  Pose map_from_odom() const { return map_from_odom_; }
  Pose odom_from_base() const { return odom_from_base_.value_or(Pose::Identity()); }
  Pose map_from_base() const { return map_from_odom_ * odom_from_base(); }

 private:
  Pose odom_from_session_ = Pose::Identity();
  std::optional<Pose> odom_from_base_;  // none before the first frame
  Pose map_from_odom_ = Pose::Identity();
  bool is_new_session_ = true;
};

}  // namespace samewhere::node
