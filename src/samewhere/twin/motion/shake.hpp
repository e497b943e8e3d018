#pragma once

#include <vector>

#include <samewhere/core/random.hpp>
#include <samewhere/twin/building/route.hpp>

namespace samewhere::twin {

// A function of one variable at one place, with its first and second derivative there.
struct Jet {
  double value = 0.0;
  double first = 0.0;
  double second = 0.0;
};

Jet operator+(const Jet& a, const Jet& b);
Jet operator*(const Jet& a, const Jet& b);
Jet operator*(double a, const Jet& b);
Jet sin(const Jet& angle_rad);
Jet cos(const Jet& angle_rad);

// amplitude * sin(2 pi frequency x + phase); the frequency is per unit of x: hertz or per metre.
struct Wave {
  double amplitude = 0.0;
  double frequency = 0.0;
  double phase_rad = 0.0;
};
using Waves = std::vector<Wave>;

Jet sum_at(const Waves& waves, double x);

// A smooth random motion: three waves of unrelated frequencies around `mean_frequency`. Its values
// stay within kLargestWobble times `amplitude`.
inline constexpr double kLargestWobble = 1.8;
Waves random_waves(core::Random& random, double amplitude, double mean_frequency);

// How the camera moves on its carrier, as waves over time in seconds. Offsets are along the
// carrier's heading, its left and up; angles are those of motion.hpp.
struct CameraShake {
  // grows with the carrier's speed, none where it stands: steps, vibration
  Waves forward_m;
  Waves left_m;
  Waves up_m;
  Waves yaw_rad;
  Waves pitch_rad;
  Waves roll_rad;
  // looking around; a share of it stays where the carrier stands
  Waves look_yaw_rad;
  Waves look_pitch_rad;
  Waves look_roll_rad;

  double mean_pitch_rad = 0.0;
  double slope_share = 0.0;  // of the way's slope that the camera's pitch follows
};

CameraShake camera_shake(Carrier carrier, core::Random& random);

}  // namespace samewhere::twin
