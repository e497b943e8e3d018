#include <algorithm>
#include <cmath>

#include <samewhere/twin/building/angles.hpp>
#include <samewhere/twin/motion/leg.hpp>

namespace samewhere::twin {
namespace {

constexpr double kGrid_m = 0.02;  // of what is computed along a way
constexpr double kLookReach_m = 1.1;
constexpr double kLookAhead_m = 0.7;  // people look into a bend before they walk it
constexpr double kSettle_m = 1.5;     // from a stop until drift and slope count in full

double smooth_ratio(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

Leg::Leg(const Path& path, const Character& character, double speed_m_s) {
  const auto num_steps = std::max(2.0, std::ceil(path.length_m() / kGrid_m));
  step_m_ = path.length_m() / num_steps;
  states_.assign(static_cast<std::size_t>(num_steps) + 1, DriveState::Zero());
  place(path);
  look(path, character.looks_ahead);
  limit_speed(character, speed_m_s);
  ease_in_and_out(character.acceleration_m_s2);
}

void Leg::place(const Path& path) {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    states_[i].head<3>() = path.position_m(static_cast<double>(i) * step_m_, kFeetReach_m);
  }
  states_.front()[kDriveHeading] = path.first_heading_rad();
  states_.back()[kDriveHeading] = path.last_heading_rad();
  for (std::size_t i = 1; i + 1 < states_.size(); ++i) {
    states_[i][kDriveHeading] = heading_between(states_[i - 1].head<3>(), states_[i + 1].head<3>(),
                                                states_[i - 1][kDriveHeading]);
  }
}

void Leg::look(const Path& path, bool looks_ahead) {
  constexpr double kBehind_m = 0.3;
  const double slope_ahead_m = looks_ahead ? kLookAhead_m : kBehind_m;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    DriveState& state = states_[i];
    const double distance_m = static_cast<double>(i) * step_m_;
    const double ahead_m =
        std::min(kLookAhead_m * smooth_ratio(distance_m / kSettle_m), path.length_m() - distance_m);
    state[kDriveLook] =
        looks_ahead ? path.heading_rad(distance_m + ahead_m, kLookReach_m) : state[kDriveHeading];
    const Eigen::Vector3d rise_m =
        (state_near(distance_m + slope_ahead_m) - state_near(distance_m - kBehind_m)).head<3>();
    const double run_m = rise_m.head<2>().norm();
    if (run_m > 1e-3) state[kDriveSlope] = settled(i) * std::atan2(rise_m.z(), run_m);
  }
}

void Leg::limit_speed(const Character& character, double speed_m_s) {
  constexpr double kReach_m = 0.8;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const double distance_m = static_cast<double>(i) * step_m_;
    const double bend_rad = state_near(distance_m + kReach_m)[kDriveHeading] -
                            state_near(distance_m - kReach_m)[kDriveHeading];
    const double corner = std::min(1.0, std::abs(bend_rad) / (0.5 * kPi));
    const double slope = std::abs(std::sin(states_[i][kDriveSlope]));
    double limit_m_s = speed_m_s * (1.0 - character.corner_slowdown * corner) *
                       (1.0 - character.slope_slowdown * slope);
    for (const std::size_t cell : {i, i + 1}) {
      if (cell == 0 || cell >= states_.size()) continue;
      const double turn_rad = std::abs(states_[cell][kDriveLook] - states_[cell - 1][kDriveLook]);
      limit_m_s =
          std::min(limit_m_s, character.turn_rate_rad_s * step_m_ / std::max(turn_rad, 1e-9));
    }
    speeds_m_s_.push_back(limit_m_s);
  }
}

// From and to a stand, with v dv/ds = a at most.
void Leg::ease_in_and_out(double acceleration_m_s2) {
  const double gain_m2_s2 = 2.0 * acceleration_m_s2 * step_m_;
  const auto limit = [&](double& speed_m_s, double neighbour_m_s) {
    speed_m_s = std::min(speed_m_s, std::sqrt(neighbour_m_s * neighbour_m_s + gain_m2_s2));
  };
  speeds_m_s_.front() = 0.0;
  speeds_m_s_.back() = 0.0;
  for (std::size_t i = 1; i < speeds_m_s_.size(); ++i) limit(speeds_m_s_[i], speeds_m_s_[i - 1]);
  for (std::size_t i = speeds_m_s_.size() - 1; i > 0; --i) {
    limit(speeds_m_s_[i - 1], speeds_m_s_[i]);
  }
}

void Leg::add_drift(const Waves& drift_m, double walked_before_m) {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const double heading_rad = states_[i][kDriveHeading];
    const double walked_m = walked_before_m + static_cast<double>(i) * step_m_;
    states_[i].head<2>() += settled(i) * sum_at(drift_m, walked_m).value *
                            Eigen::Vector2d(-std::sin(heading_rad), std::cos(heading_rad));
  }
}

DriveState Leg::state_at(double distance_m) const {
  const double cell =
      std::clamp(distance_m / step_m_, 0.0, static_cast<double>(states_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(cell), states_.size() - 2);
  const double ratio = cell - static_cast<double>(i);
  return (1.0 - ratio) * states_[i] + ratio * states_[i + 1];
}

double Leg::speed_at(double distance_m) const {
  const auto i = std::min(static_cast<std::size_t>(distance_m / step_m_), speeds_m_s_.size() - 2);
  const double ratio = distance_m / step_m_ - static_cast<double>(i);
  return std::max(kSlowest, (1.0 - ratio) * speeds_m_s_[i] + ratio * speeds_m_s_[i + 1]);
}

const DriveState& Leg::state_near(double distance_m) const {
  const double last = static_cast<double>(states_.size() - 1);
  return states_[static_cast<std::size_t>(std::clamp(distance_m / step_m_ + 0.5, 0.0, last))];
}

// 0 at a stop, 1 from kSettle_m away from it.
double Leg::settled(std::size_t i) const {
  const double from_start_m = static_cast<double>(i) * step_m_;
  const double to_end_m = length_m() - from_start_m;
  return smooth_ratio(from_start_m / kSettle_m) * smooth_ratio(to_end_m / kSettle_m);
}

}  // namespace samewhere::twin
