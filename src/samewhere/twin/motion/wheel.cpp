#include <cmath>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/twin/motion/wheel.hpp>

namespace samewhere::twin {
namespace {

// What is left of a difference of two equal numbers; the noise would take its square root.
double without_rounding(double value) { return std::abs(value) < 1e-9 ? 0.0 : value; }

WheelSample true_sample(const Motion& motion, double before_s, double stamp_s) {
  const Eigen::Vector3d step_m =
      motion.floor_position_m(stamp_s) - motion.floor_position_m(before_s);
  const double heading_before_rad = motion.heading_rad(before_s);
  const double turned_rad = motion.heading_rad(stamp_s) - heading_before_rad;
  const double middle_rad = heading_before_rad + 0.5 * turned_rad;
  const double level_m = step_m.x() * std::cos(middle_rad) + step_m.y() * std::sin(middle_rad);
  const double forward_m = std::copysign(std::hypot(level_m, step_m.z()), level_m);
  return {stamp_s, without_rounding(forward_m), without_rounding(turned_rad)};
}

// The wheels of one robot on one drive.
class Wheels {
 public:
  Wheels(const WheelNoise& noise, std::uint64_t seed)
      : noise_(noise),
        random_(core::seed_of(seed, "twin.wheel", 0)),
        forward_scale_(1.0 + noise.forward_scale_ratio * random_.gaussian()),
        turn_scale_(1.0 + noise.turn_scale_ratio * random_.gaussian()) {}

  WheelSample measured(const WheelSample& truth) {
    const double distance_m = std::abs(truth.forward_m);
    slip_or_grip(truth.stamp_s, distance_m);
    const double forward_sigma_m = noise_.forward_noise_m_sqrt_m * std::sqrt(distance_m);
    const double turn_sigma_rad =
        std::hypot(noise_.turn_noise_rad_sqrt_m * std::sqrt(distance_m),
                   noise_.turn_noise_rad_sqrt_rad * std::sqrt(std::abs(truth.turned_rad)));
    WheelSample sample = truth;
    sample.forward_m *= forward_scale_ * (1.0 + slip_ratio_);
    sample.forward_m += forward_sigma_m * random_.gaussian();
    sample.turned_rad *= turn_scale_;
    sample.turned_rad += turn_sigma_rad * random_.gaussian();
    return sample;
  }

 private:
  void slip_or_grip(double stamp_s, double distance_m) {
    const bool begins = random_.uniform() < noise_.slips_per_m * distance_m;
    const double ratio = random_.uniform(0.0, noise_.largest_slip_ratio);
    if (begins) {
      slip_ratio_ = ratio;
      slip_until_s_ = stamp_s + noise_.slip_duration_s;
    } else if (stamp_s > slip_until_s_) {
      slip_ratio_ = 0.0;
    }
  }

  WheelNoise noise_;
  core::Random random_;  // before those that draw from it
  double forward_scale_;
  double turn_scale_;
  double slip_ratio_ = 0.0;
  double slip_until_s_ = 0.0;
};

}  // namespace

std::vector<WheelSample> wheel_samples(const Motion& motion, const WheelNoise& noise,
                                       std::uint64_t seed) {
  core::require(motion.carrier() == Carrier::kRobot, "wheels are a robot's");
  const auto num_samples = static_cast<int>(std::floor(motion.duration_s() * kWheelRate_hz + 1e-9));
  Wheels wheels(noise, seed);
  std::vector<WheelSample> samples;
  for (int k = 1; k <= num_samples; ++k) {
    samples.push_back(
        wheels.measured(true_sample(motion, (k - 1) / kWheelRate_hz, k / kWheelRate_hz)));
  }
  return samples;
}

}  // namespace samewhere::twin
