#include <algorithm>
#include <cmath>
#include <variant>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/building/angles.hpp>
#include <samewhere/twin/motion/drive.hpp>
#include <samewhere/twin/motion/leg.hpp>
#include <samewhere/twin/motion/path.hpp>
#include <samewhere/twin/motion/shake.hpp>

namespace samewhere::twin {
namespace {

constexpr int kSubsteps = 10;  // of a step, for the integral of the speed
constexpr double kSubstep_s = kDriveStep_s / kSubsteps;
constexpr double kSharpestCorner_rad = 100.0 * kDegree_rad;
constexpr double kSharpestBend_rad = 185.0 * kDegree_rad;  // of corners that are rounded together

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

// Whether the last point of a way has to be stopped at because of where it leads next: a lift, or a
// bend so sharp that its rounding would turn back on itself.
bool must_stop_before(const std::vector<Eigen::Vector3d>& way_m, const Eigen::Vector3d& next_m) {
  if (way_m.size() < 2) return false;
  std::size_t i = way_m.size() - 1;
  if (is_lift(way_m[i - 1], way_m[i]) || is_lift(way_m[i], next_m)) return true;
  double heading_rad = heading_between(way_m[i], next_m, 0.0);
  double turned_rad = 0.0;
  double limit_rad = kSharpestCorner_rad;
  double distance_m = 0.0;
  for (; i > 0 && distance_m < 2.0 * kFeetReach_m; --i) {
    const double before_rad = heading_between(way_m[i - 1], way_m[i], 0.0);
    turned_rad += unwrapped(heading_rad, before_rad) - before_rad;
    if (std::abs(turned_rad) > limit_rad) return true;
    limit_rad = kSharpestBend_rad;
    heading_rad = before_rad;
    distance_m += (way_m[i] - way_m[i - 1]).norm();
  }
  return false;
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
    way_m_ = {route.start_m};
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
    if ((step.position_m - way_m_.back()).norm() < 1e-6) return;
    if (must_stop_before(way_m_, step.position_m)) walk_ahead();
    way_m_.push_back(step.position_m);
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

  // All points of the way, without a stop.
  void walk_ahead() {
    if (way_m_.size() < 2) return;
    turn_to(heading_between(way_m_[0], way_m_[1], now_[kDriveHeading]));
    Leg leg(Path(way_m_, now_[kDriveHeading]), character_, route_.speed_m_s);
    const bool rides = is_lift(way_m_[0], way_m_[1]);
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
    way_m_ = {position_m()};
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
  std::vector<Eigen::Vector3d> way_m_;  // from where it stands to points not walked to yet
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
