#include <array>
#include <cmath>

#include <Eigen/Dense>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/normalising_transform.hpp>
#include <samewhere/geometry/polynomial.hpp>
#include <samewhere/geometry/two_view.hpp>

namespace samewhere::geometry {
namespace {

using Rows9 = Eigen::Matrix<double, Eigen::Dynamic, 9>;

// One row per pair: second' F first = 0 as an equation in the row-major entries of F, between
// normalised points.
Rows9 epipolar_rows(const PixelPairs& pairs, const Eigen::Matrix3d& first_transform,
                    const Eigen::Matrix3d& second_transform) {
  Rows9 rows(static_cast<Eigen::Index>(pairs.first_px.size()), 9);
  for (std::size_t i = 0; i < pairs.first_px.size(); ++i) {
    const Eigen::Vector3d a = first_transform * pairs.first_px[i].homogeneous();
    const Eigen::Vector3d b = second_transform * pairs.second_px[i].homogeneous();
    rows.row(static_cast<Eigen::Index>(i)) << b.x() * a.transpose(), b.y() * a.transpose(),
        b.z() * a.transpose();
  }
  return rows;
}

Eigen::Matrix3d as_matrix(const Eigen::Matrix<double, 9, 1>& row_major) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(row_major.data());
}

// det(x A + (1 - x) B) is a cubic in x: its coefficients from four values.
std::array<double, 4> determinant_cubic(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  const auto value = [&](double x) { return (x * a + (1.0 - x) * b).determinant(); };
  const double at_0 = value(0.0);
  const double at_1 = value(1.0);
  const double at_minus_1 = value(-1.0);
  const double at_2 = value(2.0);
  const double c2 = 0.5 * (at_1 + at_minus_1) - at_0;
  const double odd = 0.5 * (at_1 - at_minus_1);  // c1 + c3
  const double c3 = (at_2 - at_0 - 4.0 * c2 - 2.0 * odd) / 6.0;
  return {at_0, odd - c3, c2, c3};
}

struct FundamentalRansac {
  using Model = Eigen::Matrix3d;
  static constexpr int kSampleSize = 7;
  const PixelPairs& pairs;

  int size() const { return static_cast<int>(pairs.first_px.size()); }
  std::vector<Model> generate(const std::vector<int>& sample) const;
  double squared_error(const Model& fundamental, int i) const {
    const auto k = static_cast<std::size_t>(i);
    return sampson_squared(fundamental, pairs.first_px[k], pairs.second_px[k]);
  }
};

PixelPairs subset(const PixelPairs& pairs, const std::vector<int>& indices) {
  PixelPairs chosen;
  for (const int i : indices) {
    chosen.first_px.push_back(pairs.first_px[static_cast<std::size_t>(i)]);
    chosen.second_px.push_back(pairs.second_px[static_cast<std::size_t>(i)]);
  }
  return chosen;
}

std::vector<Eigen::Matrix3d> FundamentalRansac::generate(const std::vector<int>& sample) const {
  return solve_fundamental_7(subset(pairs, sample));
}

}  // namespace

std::vector<Eigen::Matrix3d> solve_fundamental_7(const PixelPairs& seven) {
  core::require(seven.first_px.size() == 7 && seven.second_px.size() == 7,
                "the 7-point method takes seven pairs");
  const Eigen::Matrix3d first_transform = normalising_transform(seven.first_px);
  const Eigen::Matrix3d second_transform = normalising_transform(seven.second_px);
  const Rows9 rows = epipolar_rows(seven, first_transform, second_transform);
  // the two directions without an equation span all solutions; rank 2 picks one to three of them
  const Eigen::JacobiSVD<Eigen::Matrix<double, 9, 9>> svd(rows.transpose() * rows,
                                                          Eigen::ComputeFullV);
  const Eigen::Matrix3d a = as_matrix(svd.matrixV().col(7));
  const Eigen::Matrix3d b = as_matrix(svd.matrixV().col(8));
  std::vector<Eigen::Matrix3d> solutions;
  for (const double x : real_roots(determinant_cubic(a, b))) {
    solutions.emplace_back(second_transform.transpose() * (x * a + (1.0 - x) * b) *
                           first_transform);
  }
  return solutions;
}

std::optional<Eigen::Matrix3d> solve_fundamental_8(const PixelPairs& pairs) {
  if (pairs.first_px.size() < 8) return std::nullopt;
  const Eigen::Matrix3d first_transform = normalising_transform(pairs.first_px);
  const Eigen::Matrix3d second_transform = normalising_transform(pairs.second_px);
  const Rows9 rows = epipolar_rows(pairs, first_transform, second_transform);
  const Eigen::JacobiSVD<Eigen::Matrix<double, 9, 9>> equations(rows.transpose() * rows,
                                                                Eigen::ComputeFullV);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(as_matrix(equations.matrixV().col(8)),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d rank_2(svd.singularValues()(0), svd.singularValues()(1), 0.0);
  const Eigen::Matrix3d fundamental =
      svd.matrixU() * rank_2.asDiagonal() * svd.matrixV().transpose();
  if (!fundamental.allFinite()) return std::nullopt;
  return second_transform.transpose() * fundamental * first_transform;
}

double sampson_squared(const Eigen::Matrix3d& fundamental, const Eigen::Vector2d& first,
                       const Eigen::Vector2d& second) {
  const Eigen::Vector3d line_in_second = fundamental * first.homogeneous();
  const Eigen::Vector3d line_in_first = fundamental.transpose() * second.homogeneous();
  const double error = second.homogeneous().dot(line_in_second);
  return error * error /
         (line_in_second.head<2>().squaredNorm() + line_in_first.head<2>().squaredNorm());
}

std::optional<RansacResult<Eigen::Matrix3d>> estimate_fundamental(const PixelPairs& pairs,
                                                                  const RansacOptions& options,
                                                                  core::Random& random) {
  core::require(pairs.first_px.size() == pairs.second_px.size(), "pixels come in pairs");
  const FundamentalRansac problem{pairs};
  auto result = ransac(problem, options, random);
  if (!result) return std::nullopt;
  if (const auto refined = solve_fundamental_8(subset(pairs, result->inliers))) {
    RansacScore score = score_model(problem, *refined, options.max_error_px);
    if (score.inliers.size() >= result->inliers.size()) {
      result->model = *refined;
      result->inliers = std::move(score.inliers);
    }
  }
  return result;
}

}  // namespace samewhere::geometry
