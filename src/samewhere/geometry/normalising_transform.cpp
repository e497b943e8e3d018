#include <cmath>

#include <samewhere/geometry/normalising_transform.hpp>

namespace samewhere::geometry {

Eigen::Matrix3d normalising_transform(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  double distance = 0.0;
  for (const auto& p : points) distance += (p - mean).norm();
  distance /= static_cast<double>(points.size());
  const double scale = distance > 0.0 ? std::sqrt(2.0) / distance : 1.0;
  Eigen::Matrix3d transform;
  transform << scale, 0.0, -scale * mean.x(), 0.0, scale, -scale * mean.y(), 0.0, 0.0, 1.0;
  return transform;
}

}  // namespace samewhere::geometry
