#include <algorithm>
#include <array>
#include <complex>
#include <numeric>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/median.hpp>
#include <samewhere/verify/overlap.hpp>

namespace samewhere::verify {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

constexpr std::size_t kMinPairs = 4;
constexpr int kRounds = 5;  // pairs of one epipolar line that are no pairs at all fall out

Vector2d mapped(const Matrix3d& second_from_first, const Vector2d& pixel) {
  return (second_from_first * pixel.homogeneous()).hnormalized();
}

std::complex<double> as_complex(const Vector2d& v) { return {v.x(), v.y()}; }

// second = turn * first + shift over complex numbers, least squares (after Umeyama 1991, in the
// plane), as homogeneous pixels. Nothing for pairs of one point, or none.
std::optional<Matrix3d> fit_similarity(const geometry::PixelPairs& pairs,
                                       const std::vector<std::size_t>& used) {
  if (used.empty()) return std::nullopt;
  std::complex<double> mean_first;
  std::complex<double> mean_second;
  for (const std::size_t i : used) {
    mean_first += as_complex(pairs.first_px[i]) / static_cast<double>(used.size());
    mean_second += as_complex(pairs.second_px[i]) / static_cast<double>(used.size());
  }
  std::complex<double> product;
  double square = 0.0;
  for (const std::size_t i : used) {
    const std::complex<double> first = as_complex(pairs.first_px[i]) - mean_first;
    product += std::conj(first) * (as_complex(pairs.second_px[i]) - mean_second);
    square += std::norm(first);
  }
  if (square <= 0.0 || std::abs(product) <= 0.0) return std::nullopt;
  const std::complex<double> turn = product / square;
  const std::complex<double> shift = mean_second - turn * mean_first;
  Matrix3d map;
  map << turn.real(), -turn.imag(), shift.real(), turn.imag(), turn.real(), shift.imag(), 0, 0, 1;
  return map;
}

// The half of the pairs that a map explains best.
std::vector<std::size_t> better_half(const geometry::PixelPairs& pairs, const Matrix3d& map) {
  std::vector<double> errors_px;
  for (std::size_t i = 0; i < pairs.first_px.size(); ++i)
    errors_px.push_back((mapped(map, pairs.first_px[i]) - pairs.second_px[i]).norm());
  const double limit_px = core::median(errors_px).value_or(0.0);
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < errors_px.size(); ++i) {
    if (errors_px[i] <= limit_px) kept.push_back(i);
  }
  return kept;
}

// The similarity of all pairs, fitted again to the better half of them for some rounds.
std::optional<Matrix3d> fit_trimmed_similarity(const geometry::PixelPairs& pairs) {
  std::vector<std::size_t> all(pairs.first_px.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  auto map = fit_similarity(pairs, all);
  if (!map) return std::nullopt;
  for (int round = 0; round < kRounds; ++round)
    map = fit_similarity(pairs, better_half(pairs, *map)).value_or(*map);
  return map;
}

std::array<Vector2d, 4> corners_of(const cv::Size& size_px) {
  const double width = size_px.width;
  const double height = size_px.height;
  return {{{0.0, 0.0}, {width, 0.0}, {width, height}, {0.0, height}}};
}

cv::Point2f as_point(const Vector2d& pixel) {
  return {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
}

}  // namespace

double overlap_ratio(const geometry::PixelPairs& pairs, const cv::Size& first_size_px,
                     const cv::Size& second_size_px) {
  if (pairs.first_px.size() < kMinPairs) return 0.0;
  const auto second_from_first = fit_trimmed_similarity(pairs);
  if (!second_from_first) return 0.0;
  std::vector<cv::Point2f> first;
  std::vector<cv::Point2f> second;
  for (const Vector2d& corner : corners_of(first_size_px))
    first.push_back(as_point(mapped(*second_from_first, corner)));
  for (const Vector2d& corner : corners_of(second_size_px)) second.push_back(as_point(corner));
  std::vector<cv::Point2f> both;
  const double shared = cv::intersectConvexConvex(first, second, both);
  const double area = std::max(cv::contourArea(first), cv::contourArea(second));
  return area > 0.0 ? std::min(1.0, shared / area) : 0.0;
}

}  // namespace samewhere::verify
