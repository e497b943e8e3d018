#include <algorithm>
#include <cmath>
#include <numbers>

#include <samewhere/twin/building/presets_route.hpp>

namespace samewhere::twin {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

double turn_between(double from_rad, double to_rad) {
  return std::abs(std::remainder(to_rad - from_rad, 2.0 * std::numbers::pi));
}

// Adds up the time of one step after the other.
struct Stopwatch {
  double speed_m_s;
  Eigen::Vector3d position_m;
  double heading_rad;
  double sum_s = 0.0;

  void operator()(const WalkTo& step) {
    constexpr double kBend_s_rad = 0.65 / (90.0 * kDegree);
    constexpr double kOnStairs = 1.4;
    const Eigen::Vector3d way_m = step.position_m - position_m;
    const double before_rad = heading_rad;
    if (way_m.head<2>().norm() > 0.0) heading_rad = std::atan2(way_m.y(), way_m.x());
    sum_s += (way_m.z() == 0.0 ? 1.0 : kOnStairs) * way_m.norm() / speed_m_s;
    sum_s += kBend_s_rad * turn_between(before_rad, heading_rad);
    position_m = step.position_m;
  }
  void operator()(const TurnTo& step) {
    constexpr double kTurn_rad_s = 80.0 * kDegree;
    sum_s += turn_between(heading_rad, step.heading_rad) / kTurn_rad_s;
    heading_rad = step.heading_rad;
  }
  void operator()(const Stand& step) { sum_s += step.duration_s; }
  void operator()(const Darken& step) { sum_s += step.duration_s; }
};

bool holds(const std::vector<Eigen::Vector3d>& points_m, const Eigen::Vector3d& point_m) {
  constexpr double kSame_m = 0.8;
  return std::any_of(points_m.begin(), points_m.end(),
                     [&](const Eigen::Vector3d& p) { return (p - point_m).norm() < kSame_m; });
}

}  // namespace

void walk(Route& route, const std::vector<Eigen::Vector3d>& points_m) {
  for (const auto& point : points_m) route.steps.emplace_back(WalkTo{point});
}

void turn(Route& route, double heading_deg) {
  route.steps.emplace_back(TurnTo{heading_deg * kDegree});
}

double estimated_duration_s(const Route& route) {
  Stopwatch watch{route.speed_m_s, route.start_m, route.start_heading_rad};
  for (const auto& step : route.steps) std::visit(watch, step);
  return watch.sum_s;
}

std::vector<Eigen::Vector3d> points_of(const Route& route) {
  std::vector<Eigen::Vector3d> points_m{route.start_m};
  for (const auto& step : route.steps) {
    if (const auto* const to = std::get_if<WalkTo>(&step)) points_m.push_back(to->position_m);
  }
  return points_m;
}

std::vector<PersonPath> paths_along(const Route& route) {
  const auto points_m = points_of(route);
  std::vector<PersonPath> paths;
  std::vector<Eigen::Vector3d> walked_m{points_m.front()};
  PersonPath path{{points_m.front()}};
  const auto begin_at = [&](const Eigen::Vector3d& point_m) {
    if (path.points_m.size() > 1) paths.push_back(path);
    path.points_m = {point_m};
  };
  for (std::size_t i = 1; i < points_m.size(); ++i) {
    const bool is_level = points_m[i].z() == points_m[i - 1].z();
    const bool was_known = holds(walked_m, points_m[i]);
    if (!is_level || (was_known && holds(walked_m, points_m[i - 1]) && path.points_m.size() == 1)) {
      begin_at(points_m[i]);
    } else {
      path.points_m.push_back(points_m[i]);
      if (was_known) begin_at(points_m[i]);
    }
    walked_m.push_back(points_m[i]);
  }
  begin_at(points_m.back());
  return paths;
}

}  // namespace samewhere::twin
