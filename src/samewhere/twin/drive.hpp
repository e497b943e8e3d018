#pragma once

#include <vector>

#include <Eigen/Core>

#include <samewhere/core/random.hpp>
#include <samewhere/twin/route.hpp>

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

struct Darkness {
  double begin_s = 0.0;
  double end_s = 0.0;
};

struct Drive {
  std::vector<DriveState> states;  // every kDriveStep_s, from 0 to the first at or after the end
  std::vector<Darkness> darkness;
  double duration_s = 0.0;
};

inline constexpr double kDriveStep_s = 0.1;

// Rounding (of up to 0.9 m before and behind a corner) and the walker's drift take the carrier at
// most this far from the route's lines.
inline constexpr double kMostFromRoute_m = 0.5;

// Walks along a route: speeds up and slows down smoothly, slower in bends and on stairs, at a pace
// that varies a little. Corners sharper than 100 degrees, and lifts, are turned on the spot. Throws
// ContractError for a route with values that are not finite, or times or a speed below zero.
Drive drive_along(const Route& route, core::Random& random);

}  // namespace samewhere::twin
