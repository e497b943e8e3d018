#include <algorithm>
#include <cmath>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/building/angles.hpp>
#include <samewhere/twin/motion/path.hpp>

namespace samewhere::twin {
namespace {

// The bell's integral from -1 to x in [-1, 1]: a step, rounded.
double rounded_step(double x) { return 0.5 * (1.0 + x + std::sin(kPi * x) / kPi); }

// Its integral: a ramp, rounded.
double rounded_ramp(double x) {
  return 0.25 * (1.0 + x) * (1.0 + x) - 0.5 * (1.0 + std::cos(kPi * x)) / (kPi * kPi);
}

}  // namespace

Path::Path(std::vector<Eigen::Vector3d> points_m, double heading_before_rad)
    : points_m_(std::move(points_m)) {
  core::require(points_m_.size() >= 2, "a path has at least two points");
  starts_m_.push_back(0.0);
  double heading_rad = heading_before_rad;
  for (std::size_t i = 1; i < points_m_.size(); ++i) {
    const Eigen::Vector3d step_m = points_m_[i] - points_m_[i - 1];
    core::require(step_m.norm() > 0.0, "no two points of a path in a row are equal");
    heading_rad = heading_between(points_m_[i - 1], points_m_[i], heading_rad);
    starts_m_.push_back(starts_m_.back() + step_m.norm());
    directions_.push_back(step_m.normalized());
    headings_rad_.push_back(heading_rad);
  }
}

Eigen::Vector3d Path::position_m(double distance_m, double reach_m) const {
  const double reach_here_m = reach_at(distance_m, reach_m);
  const auto here = static_cast<std::size_t>(segment_at(distance_m));
  Eigen::Vector3d position_m = points_m_[here] + (distance_m - starts_m_[here]) * directions_[here];
  const int last = segment_at(distance_m + reach_here_m);
  for (int i = segment_at(distance_m - reach_here_m) + 1; i <= last; ++i) {
    const auto corner = static_cast<std::size_t>(i);
    const double past_m = distance_m - starts_m_[corner];
    if (std::abs(past_m) >= reach_here_m) continue;
    position_m += (reach_here_m * rounded_ramp(past_m / reach_here_m) - std::max(past_m, 0.0)) *
                  (directions_[corner] - directions_[corner - 1]);
  }
  return position_m;
}

double Path::heading_rad(double distance_m, double reach_m) const {
  const double reach_here_m = reach_at(distance_m, reach_m);
  double heading_rad = headings_rad_[static_cast<std::size_t>(segment_at(distance_m))];
  const int last = segment_at(distance_m + reach_here_m);
  for (int i = segment_at(distance_m - reach_here_m) + 1; i <= last; ++i) {
    const auto corner = static_cast<std::size_t>(i);
    const double past_m = distance_m - starts_m_[corner];
    if (std::abs(past_m) >= reach_here_m) continue;
    heading_rad += (rounded_step(past_m / reach_here_m) - (past_m >= 0.0 ? 1.0 : 0.0)) *
                   (headings_rad_[corner] - headings_rad_[corner - 1]);
  }
  return heading_rad;
}

int Path::segment_at(double distance_m) const {
  const auto after = std::upper_bound(starts_m_.begin(), starts_m_.end(), distance_m);
  const auto last = static_cast<int>(directions_.size()) - 1;
  return std::clamp(static_cast<int>(after - starts_m_.begin()) - 1, 0, last);
}

double Path::reach_at(double distance_m, double reach_m) const {
  return std::max(0.0, std::min({reach_m, distance_m, length_m() - distance_m}));
}

double heading_between(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m,
                       double heading_before_rad) {
  const Eigen::Vector3d step_m = to_m - from_m;
  if (step_m.head<2>().norm() < 1e-6) return heading_before_rad;
  return unwrapped(std::atan2(step_m.y(), step_m.x()), heading_before_rad);
}

double unwrapped(double heading_rad, double from_rad) {
  const double turn_rad = std::remainder(heading_rad - from_rad, 2.0 * kPi);
  const bool is_half_turn_right = turn_rad < -kPi + 1e-9;
  return from_rad + turn_rad + (is_half_turn_right ? 2.0 * kPi : 0.0);
}

}  // namespace samewhere::twin
