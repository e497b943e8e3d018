#include <cmath>

#include <Eigen/SVD>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/alignment.hpp>

namespace samewhere::geometry {
namespace {

using Points = Eigen::Matrix3Xd;

// A direction whose covariance is below this share of the product of the two spreads is no shape (a
// lateral deviation of a millionth of the length).
constexpr double kMinStrengthRatio = 1e-12;
// Rounding of centred points, as a share of the largest coordinate before centring.
constexpr double kRoundingRatio = 1e-14;

Points as_columns(const std::vector<Eigen::Vector3d>& points) {
  Points columns(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    columns.col(static_cast<Eigen::Index>(i)) = points[i];
  return columns;
}

// Points about their mean.
struct Cloud {
  Eigen::Vector3d mean;
  Points centred;
  double spread;    // root mean square distance from the mean
  double rounding;  // how much of the spread may be rounding
};

Cloud cloud_of(const std::vector<Eigen::Vector3d>& points) {
  const Points columns = as_columns(points);
  core::require(columns.allFinite(), "points to align are finite");
  const Eigen::Vector3d mean = columns.rowwise().mean();
  const Points centred = columns.colwise() - mean;
  return {mean, centred, std::sqrt(centred.colwise().squaredNorm().mean()),
          kRoundingRatio * columns.cwiseAbs().maxCoeff()};
}

struct Shape {
  Eigen::Matrix3d to_axes, from_axes;  // U and V of the covariance of the two sets
  Eigen::Vector3d strengths;           // its singular values, descending
  int num_directions = 0;              // how many of them are not rounding
};

Shape shape_of(const Cloud& from, const Cloud& to) {
  const double count = static_cast<double>(from.centred.cols());
  const Eigen::Matrix3d covariance = to.centred * from.centred.transpose() / count;  // eq. (38)
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double least = kMinStrengthRatio * from.spread * to.spread + from.rounding * to.spread +
                       to.rounding * (from.spread + from.rounding);
  const Eigen::Vector3d& strengths = svd.singularValues();
  const int num_directions = static_cast<int>((strengths.array() > least).count());
  return {svd.matrixU(), svd.matrixV(), strengths, num_directions};
}

// The best rotation of from onto to.
Eigen::Quaterniond rotation_of(const Shape& shape) {
  if (shape.num_directions == 0) return Eigen::Quaterniond::Identity();
  if (shape.num_directions == 1)
    return Eigen::Quaterniond::FromTwoVectors(shape.from_axes.col(0), shape.to_axes.col(0));
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();  // eq. (43): no mirror image
  signs.z() = shape.to_axes.determinant() * shape.from_axes.determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::Matrix3d rotation =
      shape.to_axes * signs.asDiagonal() * shape.from_axes.transpose();  // eq. (40)
  return Eigen::Quaterniond(rotation).normalized();
}

double scale_of(const Shape& shape, double from_spread) {
  if (shape.num_directions == 0) return 1.0;
  const bool is_mirrored = shape.to_axes.determinant() * shape.from_axes.determinant() < 0.0;
  const double last = is_mirrored ? -shape.strengths.z() : shape.strengths.z();
  return (shape.strengths.x() + shape.strengths.y() + last) / (from_spread * from_spread);  // (42)
}

}  // namespace

core::Sim3 align_points(const std::vector<Eigen::Vector3d>& from,
                        const std::vector<Eigen::Vector3d>& to, bool with_scale) {
  core::require(from.size() == to.size(), "every point to align has a partner");
  core::require(from.size() >= 3, "an alignment has at least 3 pairs of points");
  const Cloud from_cloud = cloud_of(from);
  const Cloud to_cloud = cloud_of(to);
  const Shape shape = shape_of(from_cloud, to_cloud);

  core::Sim3 aligned;
  aligned.rotation = rotation_of(shape);
  if (with_scale) aligned.scale = scale_of(shape, from_cloud.spread);
  aligned.translation =
      to_cloud.mean - aligned.scale * (aligned.rotation * from_cloud.mean);  // eq. (41)
  return aligned;
}

}  // namespace samewhere::geometry
