#pragma once

#include <vector>

#include <Eigen/Core>

#include <samewhere/twin/motion/path.hpp>
#include <samewhere/twin/motion/shake.hpp>

namespace samewhere::twin {

// What a carrier does at one moment, by the names below. Headings are unwrapped.
using DriveState = Eigen::Matrix<double, 7, 1>;
enum DriveChannel {
  kDriveX,  // of the carrier on the floor, metres
  kDriveY,
  kDriveZ,
  kDriveHeading,  // of the carrier, radians
  kDriveLook,     // where the camera is meant to look: a walker looks ahead into bends
  kDriveSlope,    // of the way ahead, radians, up is positive
  kDriveMoving    // 0 where the carrier stands, 1 at its full speed
};

// m/s or rad/s: the least speed on the way from one stop to the next, or nothing would ever start.
inline constexpr double kSlowest = 0.03;

// A corner is rounded this far before and behind (path.hpp).
inline constexpr double kFeetReach_m = 0.9;

// How a carrier moves.
struct Character {
  double turn_rate_rad_s = 0.0;
  double turn_acceleration_rad_s2 = 0.0;
  double acceleration_m_s2 = 0.0;
  double corner_slowdown = 0.0;  // share of the speed lost in the middle of a right angle
  double slope_slowdown = 0.0;   // and on a vertical wall
  double mean_pace = 1.0;
  Waves pace_ratio;  // over seconds
  Waves drift_m;     // to the left, over metres walked
  bool looks_ahead = false;
};

// A way from one stop to the next, computed on a grid of equal distances. Distances are along the
// path's sharp lines. The carrier faces the way it goes; speed is limited by bends, slopes, the
// rate at which the camera turns, and the carrier's acceleration.
class Leg {
 public:
  Leg(const Path& path, const Character& character, double speed_m_s);

  double length_m() const { return step_m_ * static_cast<double>(states_.size() - 1); }
  // All channels but kDriveMoving.
  DriveState state_at(double distance_m) const;
  // In m/s, at least kSlowest.
  double speed_at(double distance_m) const;
  // Shifts the way to the side, as waves over the distance walked since the route's start; not at
  // its two ends.
  void add_drift(const Waves& drift_m, double walked_before_m);

 private:
  void place(const Path& path);
  void look(const Path& path, bool looks_ahead);
  void limit_speed(const Character& character, double speed_m_s);
  void ease_in_and_out(double acceleration_m_s2);
  const DriveState& state_near(double distance_m) const;
  double settled(std::size_t i) const;

  double step_m_;
  std::vector<DriveState> states_;
  std::vector<double> speeds_m_s_;
};

}  // namespace samewhere::twin
