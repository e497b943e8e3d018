#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/drive.hpp>
#include <samewhere/twin/path.hpp>
#include <samewhere/twin/shake.hpp>

namespace samewhere::twin {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree_rad = kPi / 180.0;

constexpr int kSubsteps = 10;  // of a step, for the integral of the speed
constexpr double kSubstep_s = kDriveStep_s / kSubsteps;
constexpr double kGrid_m = 0.02;  // of what is computed along a way
constexpr double kFeetReach_m = 0.9;
constexpr double kLookReach_m = 1.1;
constexpr double kLookAhead_m = 0.7;  // people look into a bend before they walk it
constexpr double kSettle_m = 1.5;     // from a stop until drift and slope count in full
constexpr double kSharpest_rad = 100.0 * kDegree_rad;
constexpr double kSlowest = 0.03;  // m/s or rad/s, or nothing would ever start

struct Character {
  double turn_rate_rad_s = 0.0;
  double turn_acceleration_rad_s2 = 0.0;
  double acceleration_m_s2 = 0.0;
  double corner_slowdown = 0.0;  // share of the speed lost in the middle of a right angle
  double slope_slowdown = 0.0;   // and on a vertical wall
  double mean_pace = 1.0;
  Waves pace_ratio;  // over seconds
  Waves drift_m;     // to the left, over metres walked
  bool looks_ahead = false;
};

Character character_of(Carrier carrier, core::Random& random) {
  if (carrier == Carrier::kRobot) {
    return {.turn_rate_rad_s = 55.0 * kDegree_rad,
            .turn_acceleration_rad_s2 = 2.0,
            .acceleration_m_s2 = 0.6,
            .corner_slowdown = 0.2,
            .slope_slowdown = 0.3,
            .mean_pace = random.uniform(0.98, 1.02),
            .pace_ratio = random_waves(random, 0.015, 0.1),
            .drift_m = {},
            .looks_ahead = false};
  }
  return {.turn_rate_rad_s = 70.0 * kDegree_rad,
          .turn_acceleration_rad_s2 = 3.0,
          .acceleration_m_s2 = 1.2,
          .corner_slowdown = 0.3,
          .slope_slowdown = 0.6,
          .mean_pace = random.uniform(0.96, 1.04),
          .pace_ratio = random_waves(random, 0.06, 0.1),
          .drift_m = random_waves(random, 0.12, 0.085),
          .looks_ahead = true};
}

bool is_lift(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) {
  const Eigen::Vector3d step_m = to_m - from_m;
  return step_m.head<2>().norm() < 0.05 * step_m.norm();
}

double smooth_ratio(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// A way without a stop, computed on a grid of equal distances.
class Leg {
 public:
  Leg(const Path& path, const Character& character, double speed_m_s);

  double length_m() const { return step_m_ * static_cast<double>(states_.size() - 1); }
  // All but kDriveMoving.
  DriveState state_at(double distance_m) const;
  double speed_at(double distance_m) const;
  void add_drift(const Waves& drift_m, double walked_before_m);

 private:
  void place(const Path& path);
  void look(const Path& path, bool looks_ahead);
  void limit_speed(const Character& character, double speed_m_s);
  void ease_in_and_out(double acceleration_m_s2);
  const DriveState& state_near(double distance_m) const;
  double settled(std::size_t i) const;

  double step_m_;
  std::vector<DriveState> states_;
  std::vector<double> speeds_m_s_;
};

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

// Takes the steps of a route one after the other and writes down what happens.
class Driver {
 public:
  Driver(const Route& route, core::Random& random)
      : route_(route), character_(character_of(route.carrier, random)) {
    now_.setZero();
    now_.head<3>() = route.start_m;
    now_[kDriveHeading] = route.start_heading_rad;
    now_[kDriveLook] = route.start_heading_rad;
  }

  Drive drive() {
    drive_.states.push_back(now_);
    for (const Step& step : route_.steps) std::visit([this](const auto& s) { take(s); }, step);
    walk_ahead();
    while (num_substeps_ % kSubsteps != 0) write_down();
    drive_.duration_s = kDriveStep_s * static_cast<double>(drive_.states.size() - 1);
    return drive_;
  }

 private:
  void take(const WalkTo& step) {
    const Eigen::Vector3d last_m = ahead_m_.empty() ? position_m() : ahead_m_.back();
    if ((step.position_m - last_m).norm() < 1e-6) return;
    if (!ahead_m_.empty() && must_stop_at_last_point(step.position_m)) walk_ahead();
    ahead_m_.push_back(step.position_m);
  }

  void take(const TurnTo& step) {
    walk_ahead();
    turn_to(step.heading_rad);
  }

  void take(const Stand& step) {
    walk_ahead();
    stand(step.duration_s);
  }

  void take(const Darken& step) {
    walk_ahead();
    const double begin_s = stamp_s();
    stand(step.duration_s);
    drive_.darkness.push_back({begin_s, stamp_s()});
  }

  Eigen::Vector3d position_m() const { return now_.head<3>(); }
  double stamp_s() const { return kSubstep_s * num_substeps_; }

  bool must_stop_at_last_point(const Eigen::Vector3d& next_m) const {
    const Eigen::Vector3d corner_m = ahead_m_.back();
    const Eigen::Vector3d before_m =
        ahead_m_.size() > 1 ? ahead_m_[ahead_m_.size() - 2] : position_m();
    if (is_lift(before_m, corner_m) || is_lift(corner_m, next_m)) return true;
    const double heading_rad = heading_between(before_m, corner_m, 0.0);
    return std::abs(heading_between(corner_m, next_m, heading_rad) - heading_rad) > kSharpest_rad;
  }

  // All points that wait, without a stop.
  void walk_ahead() {
    if (ahead_m_.empty()) return;
    ahead_m_.insert(ahead_m_.begin(), position_m());
    turn_to(heading_between(ahead_m_[0], ahead_m_[1], now_[kDriveHeading]));
    Leg leg(Path(ahead_m_, now_[kDriveHeading]), character_, route_.speed_m_s);
    const bool rides = is_lift(ahead_m_[0], ahead_m_[1]);
    if (!rides) leg.add_drift(character_.drift_m, walked_m_);
    double distance_m = 0.0;
    while (distance_m < leg.length_m()) {
      const double speed_m_s = leg.speed_at(distance_m);
      distance_m += pace() * speed_m_s * kSubstep_s;
      now_ = leg.state_at(distance_m);
      now_[kDriveMoving] = rides ? 0.0 : std::min(1.0, speed_m_s / route_.speed_m_s);
      write_down();
    }
    walked_m_ += leg.length_m();
    now_ = leg.state_at(leg.length_m());
    ahead_m_.clear();
  }

  void turn_to(double heading_rad) {
    const double begin_rad = now_[kDriveHeading];
    const double turn_rad = unwrapped(heading_rad, begin_rad) - begin_rad;
    const double angle_rad = std::abs(turn_rad);
    if (angle_rad < 1e-9) return;
    const double gain_rad_s2 = 2.0 * character_.turn_acceleration_rad_s2;
    double turned_rad = 0.0;
    while (turned_rad < angle_rad) {
      const double rate_rad_s = std::max(
          kSlowest, std::min({character_.turn_rate_rad_s, std::sqrt(gain_rad_s2 * turned_rad),
                              std::sqrt(gain_rad_s2 * (angle_rad - turned_rad))}));
      turned_rad = std::min(angle_rad, turned_rad + pace() * rate_rad_s * kSubstep_s);
      face(begin_rad + std::copysign(turned_rad, turn_rad));
      now_[kDriveMoving] = rate_rad_s / character_.turn_rate_rad_s;
      write_down();
    }
    now_[kDriveMoving] = 0.0;
  }

  void face(double heading_rad) {
    now_[kDriveHeading] = heading_rad;
    now_[kDriveLook] = heading_rad;
  }

  void stand(double duration_s) {
    const double end_s = stamp_s() + duration_s;
    while (stamp_s() < end_s - 0.5 * kSubstep_s) write_down();
  }

  double pace() const {
    return character_.mean_pace * (1.0 + sum_at(character_.pace_ratio, stamp_s()).value);
  }

  void write_down() {
    if (++num_substeps_ % kSubsteps == 0) drive_.states.push_back(now_);
  }

  const Route& route_;
  Character character_;
  DriveState now_;
  std::vector<Eigen::Vector3d> ahead_m_;  // points of the route that were not walked to yet
  double walked_m_ = 0.0;
  int num_substeps_ = 0;
  Drive drive_;
};

bool is_sound(const Step& step) {
  if (const auto* walk = std::get_if<WalkTo>(&step)) return walk->position_m.allFinite();
  if (const auto* turn = std::get_if<TurnTo>(&step)) return std::isfinite(turn->heading_rad);
  const auto* pause = std::get_if<Stand>(&step);
  const double duration_s = pause ? pause->duration_s : std::get<Darken>(step).duration_s;
  return std::isfinite(duration_s) && duration_s >= 0.0;
}

}  // namespace

Drive drive_along(const Route& route, core::Random& random) {
  core::require(route.start_m.allFinite() && std::isfinite(route.start_heading_rad),
                "a route starts at a finite pose");
  core::require(std::isfinite(route.speed_m_s) && route.speed_m_s > 0.0,
                "a route has a speed above zero");
  core::require(std::all_of(route.steps.begin(), route.steps.end(), is_sound),
                "a route's steps are finite and take no negative time");
  return Driver(route, random).drive();
}

}  // namespace samewhere::twin
