#include <cmath>

#include <Eigen/Dense>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/homography.hpp>
#include <samewhere/geometry/normalising_transform.hpp>

namespace samewhere::geometry {
namespace {

using Rows9 = Eigen::Matrix<double, Eigen::Dynamic, 9>;

std::vector<Eigen::Vector2d> on_plane(const std::vector<Eigen::Vector3d>& rays) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(rays.size());
  for (const auto& ray : rays) points.emplace_back(ray.hnormalized());
  return points;
}

// Two rows per pair: second x (H first) = 0 in the row-major entries of H.
Rows9 transfer_rows(const std::vector<Eigen::Vector2d>& first,
                    const std::vector<Eigen::Vector2d>& second,
                    const Eigen::Matrix3d& first_transform,
                    const Eigen::Matrix3d& second_transform) {
  Rows9 rows = Rows9::Zero(2 * static_cast<Eigen::Index>(first.size()), 9);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const Eigen::Vector3d a = first_transform * first[i].homogeneous();
    const Eigen::Vector3d b = second_transform * second[i].homogeneous();
    const auto row = 2 * static_cast<Eigen::Index>(i);
    rows.block<1, 3>(row, 3) = -a.transpose();
    rows.block<1, 3>(row, 6) = b.y() * a.transpose();
    rows.block<1, 3>(row + 1, 0) = a.transpose();
    rows.block<1, 3>(row + 1, 6) = -b.x() * a.transpose();
  }
  return rows;
}

struct HomographyRansac {
  using Model = Homography;
  static constexpr int kSampleSize = 4;
  const RayPairs& pairs;

  int size() const { return pairs.size(); }
  std::vector<Model> generate(const std::vector<int>& sample) const {
    const auto model = solve_homography(subset(pairs, sample));
    return model ? std::vector{*model} : std::vector<Model>{};
  }
  double squared_error(const Model& model, int i) const {
    return transfer_error(model, pairs, i).larger();
  }
};

double squared_distance(const Eigen::Matrix3d& to_from, const Eigen::Vector3d& from,
                        const Eigen::Vector3d& to) {
  return ((to_from * from).hnormalized() - to.hnormalized()).squaredNorm();
}

// The motion under which H = R + t n' with this unit vector u in the plane of the candidate
// normals.
PlanarMotion motion_along(const Eigen::Matrix3d& h, const Eigen::Vector3d& middle,
                          const Eigen::Vector3d& u) {
  Eigen::Matrix3d from;
  from << middle, u, middle.cross(u);
  Eigen::Matrix3d to;
  to << h * middle, h * u, (h * middle).cross(h * u);
  const Eigen::Matrix3d rotation = to * from.transpose();
  const Eigen::Vector3d normal = middle.cross(u);
  return {{Eigen::Quaterniond(rotation).normalized(), (h - rotation) * normal}, normal};
}

}  // namespace

std::optional<Homography> solve_homography(const RayPairs& pairs) {
  if (pairs.size() < 4) return std::nullopt;
  const auto first = on_plane(pairs.first);
  const auto second = on_plane(pairs.second);
  const Eigen::Matrix3d first_transform = normalising_transform(first);
  const Eigen::Matrix3d second_transform = normalising_transform(second);
  const Rows9 rows = transfer_rows(first, second, first_transform, second_transform);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> equations(rows.transpose() *
                                                                             rows);
  const Eigen::Matrix<double, 9, 1> entries = equations.eigenvectors().col(0);
  const Eigen::Matrix3d normalised =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(entries.data());
  if (!(std::abs(normalised.determinant()) > 1e-9)) return std::nullopt;
  const Eigen::Matrix3d h = second_transform.inverse() * normalised * first_transform;
  return Homography{h, h.inverse()};
}

TransferError transfer_error(const Homography& homography, const RayPairs& pairs, int i) {
  const auto k = static_cast<std::size_t>(i);
  const double squared_px = pairs.focal_px * pairs.focal_px;
  return {
      squared_px * squared_distance(homography.first_from_second, pairs.second[k], pairs.first[k]),
      squared_px * squared_distance(homography.second_from_first, pairs.first[k], pairs.second[k])};
}

std::optional<RansacResult<Homography>> estimate_homography(const RayPairs& pairs,
                                                            const RansacOptions& options,
                                                            core::Random& random) {
  core::require(pairs.first.size() == pairs.second.size(), "rays come in pairs");
  const HomographyRansac problem{pairs};
  auto result = ransac(problem, options, random);
  if (!result) return std::nullopt;
  if (const auto refined = solve_homography(subset(pairs, result->inliers))) {
    RansacScore score = score_model(problem, *refined, options.max_error_px);
    if (score.inliers.size() >= result->inliers.size()) {
      result->model = *refined;
      result->inliers = std::move(score.inliers);
    }
  }
  return result;
}

std::vector<PlanarMotion> motions_of(const Homography& homography) {
  constexpr double kMinSpread = 1e-6;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(homography.second_from_first, Eigen::ComputeFullV);
  // H = R + t n' has the middle singular value 1 and moves points in front to points in front
  Eigen::Matrix3d h = homography.second_from_first / svd.singularValues()(1);
  if (h.determinant() < 0.0) h = -h;
  const Eigen::Vector3d s = svd.singularValues() / svd.singularValues()(1);
  const double above = s(0) * s(0) - 1.0;
  const double below = 1.0 - s(2) * s(2);
  if (!(above + below > kMinSpread)) return {};

  const Eigen::Matrix3d& v = svd.matrixV();
  std::vector<PlanarMotion> motions;
  for (const double sign : {1.0, -1.0}) {
    const Eigen::Vector3d u =
        (std::sqrt(below) * v.col(0) + sign * std::sqrt(above) * v.col(2)).normalized();
    const PlanarMotion motion = motion_along(h, v.col(1), u);
    motions.push_back(motion);
    motions.push_back({{motion.second_from_first.rotation, -motion.second_from_first.translation},
                       -motion.normal_in_first});
  }
  return motions;
}

}  // namespace samewhere::geometry
