#pragma once

#include <cstdint>
#include <string>

#include <samewhere/core/truth.hpp>

namespace samewhere::evaluate {

// Errors of odometry that is poor on purpose.
struct Degradation {
  double distance_ratio = 0.0;     // end of 100 m straight ahead, off by this share
  double rad_per_metre = 0.0;      // of the heading
  bool has_slips = false;          // short stretches count 0 to 70 %, or 130 to 200 %
  bool has_outages = false;        // 5 s without rows, about once a minute
  bool is_without_height = false;  // as wheels in a lift
};

// From "5%", "1deg/m", "slip", "outage", "lift", or several joined by '+'. Throws InputError on
// another word, and on a number that is not positive or above 100 % or 45 degrees.
Degradation degradation_of(const std::string& kinds);

// Odometry with these errors from true poses world_from_body: distances and heading each with a
// constant and a random error, about the axis that the body turns about most. The first pose is
// the true one. Slips, outages and lift have 1 % of distance too, unless another share is given.
// The same poses and seed give the same odometry.
core::Trajectory degraded(const core::Trajectory& truth, Degradation degradation,
                          std::uint64_t seed);

}  // namespace samewhere::evaluate
