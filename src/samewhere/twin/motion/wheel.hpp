#pragma once

#include <cstdint>
#include <vector>

#include <samewhere/twin/motion/motion.hpp>

namespace samewhere::twin {

inline constexpr double kWheelRate_hz = 50.0;

// What a robot's wheels say it did since the sample before: metres along its heading, on a ramp
// along the ramp, and radians turned to the left.
struct WheelSample {
  double stamp_s = 0.0;
  double forward_m = 0.0;
  double turned_rad = 0.0;
};

// How wheels err. The scales are drawn once: the tyres' radius and the wheels' distance are not
// quite what the robot thinks. The random part's variance grows with the distance and the angle
// turned, as for Thrun, Burgard and Fox (Probabilistic Robotics, 2005, section 5.4), and so does
// not depend on the rate. A slip is a short time in which the wheels turn faster than the floor
// passes.
struct WheelNoise {
  double forward_scale_ratio = 0.01;     // 1 sigma
  double turn_scale_ratio = 0.02;        // 1 sigma
  double forward_noise_m_sqrt_m = 5e-3;  // 1 sigma after the first metre
  double turn_noise_rad_sqrt_m = 5e-3;   // 1 sigma after the first metre
  double turn_noise_rad_sqrt_rad = 0.01;
  double slips_per_m = 0.02;
  double slip_duration_s = 0.3;
  double largest_slip_ratio = 0.3;  // metres too many per metre, at most; half a slip on average

  static WheelNoise none() { return {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}; }
};

// Samples at stamps k / 50 Hz, k = 1, 2, ... up to the motion's end, of the carrier without the
// camera's shake. The same motion, noise and seed give the same samples. Throws ContractError if a
// robot is not what moves: people have no wheels.
std::vector<WheelSample> wheel_samples(const Motion& motion, const WheelNoise& noise,
                                       std::uint64_t seed);

}  // namespace samewhere::twin
