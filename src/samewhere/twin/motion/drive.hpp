#pragma once

#include <vector>

#include <samewhere/core/random.hpp>
#include <samewhere/twin/building/route.hpp>
#include <samewhere/twin/motion/leg.hpp>

namespace samewhere::twin {

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
// that varies a little. Before and after lifts, at corners sharper than 100
// degrees and within bends of more than 185, the carrier stops and turns on the spot. Throws
// ContractError for a route with values that are not finite, or times or a speed below zero.
Drive drive_along(const Route& route, core::Random& random);

}  // namespace samewhere::twin
