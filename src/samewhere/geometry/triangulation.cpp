#include <algorithm>
#include <cmath>

#include <samewhere/geometry/triangulation.hpp>

namespace samewhere::geometry {

std::optional<Eigen::Vector3d> triangulate(const core::Rigid3& second_from_first,
                                           const Eigen::Vector3d& first_bearing,
                                           const Eigen::Vector3d& second_bearing) {
  constexpr double kMinSine = 1e-9;
  const Eigen::Vector3d& t = second_from_first.translation;
  const Eigen::Vector3d a = second_from_first.rotation * first_bearing;
  const Eigen::Vector3d& b = second_bearing;
  const double sine = a.cross(b).norm();
  const double weight_a = a.cross(t).norm();
  const double weight_b = b.cross(t).norm();
  if (sine < kMinSine || weight_a + weight_b == 0.0) return std::nullopt;
  const double depth_a = weight_b / sine;
  const double depth_b = weight_a / sine;

  // the distance between the two points must be smallest with both in front
  const double gap = (t + depth_a * a - depth_b * b).squaredNorm();
  const double gap_elsewhere = std::min({(t + depth_a * a + depth_b * b).squaredNorm(),
                                         (t - depth_a * a - depth_b * b).squaredNorm(),
                                         (t - depth_a * a + depth_b * b).squaredNorm()});
  if (gap >= gap_elsewhere) return std::nullopt;
  const Eigen::Vector3d in_second =
      weight_a / (weight_a + weight_b) * (t + depth_a * (a + b));  // eq. (10) of the paper
  return inverse(second_from_first) * in_second;
}

double parallax_rad(const Eigen::Quaterniond& second_from_first,
                    const Eigen::Vector3d& first_bearing, const Eigen::Vector3d& second_bearing) {
  const Eigen::Vector3d turned = second_from_first * first_bearing;
  return std::atan2(turned.cross(second_bearing).norm(), turned.dot(second_bearing));
}

}  // namespace samewhere::geometry
