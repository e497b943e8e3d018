#include <array>
#include <cmath>
#include <numbers>

#include <samewhere/core/random.hpp>
#include <samewhere/twin/office_loop.hpp>

namespace samewhere::twin {
namespace {

constexpr double kPi = std::numbers::pi;

// The middle of the corridor: a rectangle around the origin with rounded corners, walked counter-
// clockwise from a point on its lower side.
constexpr double kHalfWidth_m = 7.0;
constexpr double kHalfHeight_m = 4.0;
constexpr double kCornerRadius_m = 1.3;
constexpr double kStartX_m = -3.5;
constexpr double kSecondLap_m = 7.5;

constexpr double kSpeed_m_s = 1.32;
constexpr double kCornerSlowdown = 0.45;  // share of the speed lost in the middle of a corner
constexpr double kLookAhead_m = 0.9;      // people look into a bend before they walk it
constexpr double kStepSmoothing_m = 0.5;  // half the stretch that the feet round off
constexpr double kLookSmoothing_m = 1.1;  // and that the eyes do

struct PathPoint {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  double heading_rad = 0.0;  // grows from lap to lap
};

constexpr double kStraights_m[] = {2.0 * (kHalfWidth_m - kCornerRadius_m),
                                   2.0 * (kHalfHeight_m - kCornerRadius_m)};
constexpr double kArc_m = 0.5 * kPi * kCornerRadius_m;
constexpr double kPerimeter_m = 2.0 * (kStraights_m[0] + kStraights_m[1]) + 4.0 * kArc_m;

// `distance_m` along the path, of any sign.
PathPoint sharp_path(double distance_m) {
  const double from_corner_m = distance_m + kStartX_m + 0.5 * kStraights_m[0];
  const double laps = std::floor(from_corner_m / kPerimeter_m);
  double rest_m = from_corner_m - laps * kPerimeter_m;
  Eigen::Vector2d position_m(-0.5 * kStraights_m[0], -kHalfHeight_m);
  for (int side = 0;; ++side) {
    const double heading_rad = 0.5 * kPi * side;
    const Eigen::Vector2d forward(std::cos(heading_rad), std::sin(heading_rad));
    const Eigen::Vector2d left(-forward.y(), forward.x());
    const double straight_m = kStraights_m[side % 2];
    const double lap_heading_rad = 2.0 * kPi * laps + heading_rad;
    if (rest_m < straight_m) return {position_m + rest_m * forward, lap_heading_rad};
    position_m += straight_m * forward;
    rest_m -= straight_m;
    const double turned_rad = std::min(rest_m, kArc_m) / kCornerRadius_m;
    position_m +=
        kCornerRadius_m * (std::sin(turned_rad) * forward + (1.0 - std::cos(turned_rad)) * left);
    if (rest_m < kArc_m || side == 3) return {position_m, lap_heading_rad + turned_rad};
    rest_m -= kArc_m;
  }
}

// The path without jumps of its curvature: a mean over a stretch with weights like a bell.
PathPoint smooth_path(double distance_m, double reach_m) {
  constexpr int kHalfSamples = 8;
  PathPoint mean;
  double sum = 0.0;
  for (int i = -kHalfSamples; i <= kHalfSamples; ++i) {
    const double ratio = static_cast<double>(i) / (kHalfSamples + 1);
    const double weight = 1.0 + std::cos(kPi * ratio);
    const PathPoint point = sharp_path(distance_m + ratio * reach_m);
    mean.position_m += weight * point.position_m;
    mean.heading_rad += weight * point.heading_rad;
    sum += weight;
  }
  return {mean.position_m / sum, mean.heading_rad / sum};
}

double usual_speed_m_s(double distance_m) {
  constexpr double kReach_m = 0.8;
  const double turned_rad = smooth_path(distance_m + kReach_m, kStepSmoothing_m).heading_rad -
                            smooth_path(distance_m - kReach_m, kStepSmoothing_m).heading_rad;
  return kSpeed_m_s * (1.0 - kCornerSlowdown * turned_rad / (0.5 * kPi));
}

// A smooth random motion: three sines of unrelated frequencies.
class Wobble {
 public:
  Wobble(core::Random& random, double amplitude, double mean_hz) {
    for (auto& wave : waves_) {
      wave = {amplitude * random.uniform(0.3, 0.6), mean_hz * random.uniform(0.6, 1.5),
              random.uniform(0.0, 2.0 * kPi)};
    }
  }

  double at(double stamp_s) const {
    double sum = 0.0;
    for (const auto& wave : waves_) {
      sum += wave.amplitude * std::sin(2.0 * kPi * wave.frequency_hz * stamp_s + wave.phase_rad);
    }
    return sum;
  }

 private:
  struct Wave {
    double amplitude = 0.0;
    double frequency_hz = 0.0;
    double phase_rad = 0.0;
  };
  std::array<Wave, 3> waves_;
};

// How a person carries a camera along the path.
class Carrier {
 public:
  explicit Carrier(std::uint64_t seed)
      : random_(core::seed_of(seed, "twin.walk", 0)),
        step_hz_(random_.uniform(1.7, 1.95)),
        sideways_m_(random_, 0.12, 0.11),
        look_rad_(random_, 0.10, 0.14),
        pitch_rad_(random_, 0.03, 0.2),
        roll_rad_(random_, 0.012, 0.25),
        mean_pace_(random_.uniform(0.96, 1.04)),
        pace_ratio_(random_, 0.06, 0.1) {}

  double speed_m_s(double stamp_s, double distance_m) const {
    return mean_pace_ * (1.0 + pace_ratio_.at(stamp_s)) * usual_speed_m_s(distance_m);
  }

  core::Rigid3 world_from_camera(double stamp_s, double distance_m) const {
    const double step_rad = 2.0 * kPi * step_hz_ * stamp_s;
    const PathPoint on_path = smooth_path(distance_m, kStepSmoothing_m);
    const Eigen::Vector2d left(-std::sin(on_path.heading_rad), std::cos(on_path.heading_rad));
    const double sideways_m = sideways_m_.at(stamp_s) + 0.012 * std::sin(0.5 * step_rad);
    const Eigen::Vector2d position_m = on_path.position_m + sideways_m * left;
    const double yaw_rad = smooth_path(distance_m + kLookAhead_m, kLookSmoothing_m).heading_rad +
                           look_rad_.at(stamp_s) + 0.006 * std::sin(0.5 * step_rad + 0.7);
    const double pitch_rad = -0.06 + pitch_rad_.at(stamp_s) + 0.005 * std::sin(step_rad + 1.1);
    return {rotation(yaw_rad, pitch_rad, roll_rad_.at(stamp_s)),
            {position_m.x(), position_m.y(), 1.5 + 0.013 * std::sin(step_rad)}};
  }

 private:
  // Camera axes (x right, y down, z forward) in a world with z up.
  static Eigen::Quaterniond rotation(double yaw_rad, double pitch_rad, double roll_rad) {
    Eigen::Matrix3d world_from_level;
    world_from_level.col(0) = Eigen::Vector3d(std::sin(yaw_rad), -std::cos(yaw_rad), 0.0);
    world_from_level.col(1) = -Eigen::Vector3d::UnitZ();
    world_from_level.col(2) = Eigen::Vector3d(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
    return (Eigen::Quaterniond(world_from_level) * core::exp_so3({pitch_rad, 0.0, 0.0}) *
            core::exp_so3({0.0, 0.0, roll_rad}))
        .normalized();
  }

  core::Random random_;  // first: the others draw from it
  double step_hz_;
  Wobble sideways_m_;
  Wobble look_rad_;
  Wobble pitch_rad_;
  Wobble roll_rad_;
  double mean_pace_;
  Wobble pace_ratio_;
};

}  // namespace

core::Trajectory office_loop_walk(std::uint64_t seed) {
  constexpr int kSubsteps = 10;  // of a frame, for the integral of the speed
  const Carrier carrier(seed);
  core::Trajectory trajectory;
  double distance_m = 0.0;
  for (int frame = 0; distance_m < kPerimeter_m + kSecondLap_m; ++frame) {
    const double stamp_s = frame / kFrameRate_hz;
    trajectory.push_back({stamp_s, carrier.world_from_camera(stamp_s, distance_m)});
    for (int i = 0; i < kSubsteps; ++i) {
      distance_m += carrier.speed_m_s(stamp_s, distance_m) / (kFrameRate_hz * kSubsteps);
    }
  }
  return trajectory;
}

}  // namespace samewhere::twin
