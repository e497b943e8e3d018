#pragma once

#include <cstdint>
#include <optional>

#include <samewhere/core/truth.hpp>
#include <samewhere/twin/building/route.hpp>
#include <samewhere/twin/motion/drive.hpp>
#include <samewhere/twin/motion/recorded_shake.hpp>
#include <samewhere/twin/motion/shake.hpp>
#include <samewhere/twin/motion/stray.hpp>

namespace samewhere::twin {

// Where a route's camera is at any moment, twice continuously differentiable, with exact
// derivatives. The body is camera 0: x right, y down, z forward; the world's z is up. Yaw grows
// counter-clockwise, pitch upwards, roll clockwise as the camera sees it.
//
// The carrier's way (drive.hpp) is sampled every 0.1 s and taken as the control points of a uniform
// cubic B-spline in time; the camera shakes on it (shake.hpp). The camera stays within
// kMostFromRoute_m + 0.03 m of the route's lines, seen from above, and as much further as it strays
// (stray.hpp; a robot does not) or is shaken (recorded_shake.hpp; a robot is not). The same route
// and seed give the same motion, bit for bit; another seed another pace, drift and shake.
class Motion {
 public:
  // Throws ContractError for a route that cannot be walked (drive.hpp).
  Motion(const Route& route, std::uint64_t seed, const Stray& stray = {},
         const RecordedShake& recorded = {});

  Carrier carrier() const { return carrier_; }
  double duration_s() const { return drive_.duration_s; }
  // At any finite stamp; before 0 and after the end the carrier stands.
  core::Rigid3 world_from_body(double stamp_s) const;
  Eigen::Vector3d velocity_m_s(double stamp_s) const;            // of the body in the world
  Eigen::Vector3d acceleration_m_s2(double stamp_s) const;       // of the body in the world
  Eigen::Vector3d angular_velocity_rad_s(double stamp_s) const;  // of the body in body axes

  // The carrier's foot point on the floor and its unwrapped heading, without shake and look-around.
  Eigen::Vector3d floor_position_m(double stamp_s) const;
  double heading_rad(double stamp_s) const;

  // Which visit of the building this is, from 0; nothing while the lens is covered.
  std::optional<int> visit_at(double stamp_s) const;
  // Stamps k / rate from 0 to the duration, covered lens or not.
  core::Trajectory frames(double frame_rate_hz) const;

 private:
  struct Carried;
  struct Position;
  struct Angles;

  void take_over(const RecordedShake& recorded, std::uint64_t seed);
  Carried carried_at(double stamp_s) const;
  Position position_at(double stamp_s) const;
  Angles angles_at(double stamp_s) const;

  Carrier carrier_;
  double camera_height_m_;
  double look_aside_rad_ = 0.0;
  CameraShake shake_;
  RecordedShake recorded_;
  double recorded_from_s_ = 0.0;
  Drive drive_;
};

}  // namespace samewhere::twin
