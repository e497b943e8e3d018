#pragma once

#include <vector>

#include <Eigen/Core>

namespace samewhere::twin {

// Straight lines between points with rounded corners, by the distance along the sharp lines.
// Rounding is a mean over the stretch of `reach_m` before and behind with the weights of a bell,
// 1 + cos(pi x / reach), in closed form. The mean of a line that never runs faster than its
// distance is at most kRoundingShare * reach_m away from it, whatever the corners. Towards both
// ends the reach shrinks, so that the rounded way begins and ends where the sharp one does.
class Path {
 public:
  static constexpr double kRoundingShare = 0.298;  // 1/2 - 2/pi^2, rounded up

  // At least two points, none equal to the one before. Headings are unwrapped: each is within half
  // a turn of the one before, the first of `heading_before_rad`; a vertical line keeps the heading.
  Path(std::vector<Eigen::Vector3d> points_m, double heading_before_rad);

  double length_m() const { return starts_m_.back(); }
  double first_heading_rad() const { return headings_rad_.front(); }
  double last_heading_rad() const { return headings_rad_.back(); }
  Eigen::Vector3d position_m(double distance_m, double reach_m) const;
  double heading_rad(double distance_m, double reach_m) const;

 private:
  int segment_at(double distance_m) const;
  double reach_at(double distance_m, double reach_m) const;

  std::vector<Eigen::Vector3d> points_m_;
  std::vector<double> starts_m_;  // distance of each point
  std::vector<Eigen::Vector3d> directions_;
  std::vector<double> headings_rad_;
};

// The heading from one point to another; `heading_before_rad` if one is above the other.
double heading_between(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m,
                       double heading_before_rad);

// `heading_rad` plus whole turns, so that it is reached from `from_rad` by the shorter way; a half
// turn goes left.
double unwrapped(double heading_rad, double from_rad);

}  // namespace samewhere::twin
