#include <cmath>
#include <numbers>

#include <samewhere/twin/building/angles.hpp>
#include <samewhere/twin/motion/shake.hpp>

namespace samewhere::twin {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr double kLargestShare = kLargestWobble / 3.0;

// A person holding a camera in front of the chest.
CameraShake walker_shake(core::Random& random) {
  const double step_hz = random.uniform(1.7, 1.95);
  const double phase_rad = random.uniform(0.0, 2.0 * kTurn_rad);  // left or right foot first
  const auto with_step = [&](double amplitude, double offset_rad) -> Waves {
    return {{amplitude, step_hz, phase_rad + offset_rad}};
  };
  const auto with_stride = [&](double amplitude, double offset_rad) -> Waves {
    return {{amplitude, 0.5 * step_hz, 0.5 * phase_rad + offset_rad}};
  };
  CameraShake shake;
  shake.left_m = with_stride(0.012, 0.0);
  shake.up_m = with_step(0.013, 0.0);
  shake.yaw_rad = with_stride(0.006, 0.7);
  shake.pitch_rad = with_step(0.005, 1.1);
  shake.look_yaw_rad = random_waves(random, 0.10, 0.14);
  shake.look_pitch_rad = random_waves(random, 0.03, 0.2);
  shake.look_roll_rad = random_waves(random, 0.012, 0.25);
  shake.mean_pitch_rad = -0.06;
  shake.slope_share = 0.5;  // people look at the stairs, but not only
  return shake;
}

// A cart on hard wheels whose camera pans slowly.
CameraShake robot_shake(core::Random& random) {
  constexpr double kVibration_hz = 11.5;
  constexpr double kVibration_m = 0.2e-3;
  constexpr double kVibration_rad = 0.1 * kDegree_rad;
  CameraShake shake;
  for (Waves* offset : {&shake.forward_m, &shake.left_m, &shake.up_m}) {
    *offset = random_waves(random, kVibration_m, kVibration_hz);
  }
  for (Waves* angle : {&shake.yaw_rad, &shake.pitch_rad, &shake.roll_rad}) {
    *angle = random_waves(random, kVibration_rad, kVibration_hz);
  }
  shake.look_yaw_rad = random_waves(random, 0.12, 0.07);
  shake.slope_share = 1.0;
  return shake;
}

}  // namespace

Jet operator+(const Jet& a, const Jet& b) {
  return {a.value + b.value, a.first + b.first, a.second + b.second};
}

Jet operator*(const Jet& a, const Jet& b) {
  return {a.value * b.value, a.first * b.value + a.value * b.first,
          a.second * b.value + 2.0 * a.first * b.first + a.value * b.second};
}

Jet operator*(double a, const Jet& b) { return {a * b.value, a * b.first, a * b.second}; }

Jet sin(const Jet& angle_rad) {
  const double s = std::sin(angle_rad.value);
  const double c = std::cos(angle_rad.value);
  return {s, c * angle_rad.first, c * angle_rad.second - s * angle_rad.first * angle_rad.first};
}

Jet cos(const Jet& angle_rad) {
  const double s = std::sin(angle_rad.value);
  const double c = std::cos(angle_rad.value);
  return {c, -s * angle_rad.first, -s * angle_rad.second - c * angle_rad.first * angle_rad.first};
}

Jet sum_at(const Waves& waves, double x) {
  Jet sum;
  for (const Wave& wave : waves) {
    const double rate_rad = kTurn_rad * wave.frequency;
    sum = sum + wave.amplitude * sin(Jet{rate_rad * x + wave.phase_rad, rate_rad, 0.0});
  }
  return sum;
}

Waves random_waves(core::Random& random, double amplitude, double mean_frequency) {
  Waves waves(3);
  for (Wave& wave : waves) {
    wave.amplitude = amplitude * random.uniform(0.3, kLargestShare);
    wave.frequency = mean_frequency * random.uniform(0.6, 1.5);
    wave.phase_rad = random.uniform(0.0, kTurn_rad);
  }
  return waves;
}

CameraShake camera_shake(Carrier carrier, core::Random& random) {
  return carrier == Carrier::kWalker ? walker_shake(random) : robot_shake(random);
}

}  // namespace samewhere::twin
