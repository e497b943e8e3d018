#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include <samewhere/core/median.hpp>
#include <samewhere/geometry/homography.hpp>
#include <samewhere/verify/pair_registration.hpp>

namespace samewhere::verify {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

constexpr int kMinPairs = 8;
constexpr double kMaxErrorRatio = 0.02;  // of the width
constexpr double kMaxStretch = 3.0;      // longest by shortest side of what a square becomes
constexpr double kMaxScale = 4.0;

// Pixels of a pinhole that stands in for an unknown camera: a homography does not care which.
Matrix3d stand_in_camera(const cv::Size& size_px) {
  const double focal_px = std::max(size_px.width, size_px.height);
  Matrix3d pixel_from_ray;
  pixel_from_ray << focal_px, 0.0, 0.5 * size_px.width, 0.0, focal_px, 0.5 * size_px.height, 0.0,
      0.0, 1.0;
  return pixel_from_ray;
}

geometry::RayPairs rays_of(const geometry::PixelPairs& pairs, const Matrix3d& pixel_from_ray) {
  const Matrix3d ray_from_pixel = pixel_from_ray.inverse();
  geometry::RayPairs rays{.first = {}, .second = {}, .focal_px = pixel_from_ray(0, 0)};
  for (std::size_t i = 0; i < pairs.first_px.size(); ++i) {
    rays.first.push_back((ray_from_pixel * pairs.first_px[i].homogeneous()).normalized());
    rays.second.push_back((ray_from_pixel * pairs.second_px[i].homogeneous()).normalized());
  }
  return rays;
}

// Derivative of where a pixel lies, by the pixel.
Eigen::Matrix2d local_map(const Matrix3d& to_from, const Vector2d& pixel) {
  const double depth = to_from.row(2).dot(pixel.homogeneous());
  const Vector2d there = mapped(to_from, pixel);
  return (to_from.topLeftCorner<2, 2>() - there * to_from.block<1, 2>(2, 0)) / depth;
}

bool is_gentle_at(const Matrix3d& to_from, const Vector2d& pixel) {
  if (!mapped(to_from, pixel).allFinite()) return false;
  const Eigen::Matrix2d map = local_map(to_from, pixel);
  const double area = map.determinant();
  if (!(area > 1.0 / (kMaxScale * kMaxScale)) || area > kMaxScale * kMaxScale) return false;
  // s1^2 + s2^2 = |map|^2 and s1 s2 = area, so this is s1/s2 + s2/s1
  return map.squaredNorm() / area <= kMaxStretch + 1.0 / kMaxStretch;
}

// At the corners of the box around the pairs, where a homography departs most from a similarity.
bool is_gentle(const Matrix3d& to_from, const std::vector<Vector2d>& pixels) {
  Vector2d low = pixels.front();
  Vector2d high = pixels.front();
  for (const Vector2d& pixel : pixels) {
    low = low.cwiseMin(pixel);
    high = high.cwiseMax(pixel);
  }
  return is_gentle_at(to_from, low) && is_gentle_at(to_from, high) &&
         is_gentle_at(to_from, {low.x(), high.y()}) && is_gentle_at(to_from, {high.x(), low.y()});
}

std::complex<double> as_complex(const Vector2d& v) { return {v.x(), v.y()}; }

// second = turn * first + shift over complex numbers, least squares.
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

}  // namespace

std::optional<Registration> register_by_similarity(const geometry::PixelPairs& pairs,
                                                   int num_rounds) {
  std::vector<std::size_t> all(pairs.first_px.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  auto map = fit_similarity(pairs, all);
  if (!map) return std::nullopt;
  for (int round = 0; round < num_rounds; ++round)
    map = fit_similarity(pairs, better_half(pairs, *map)).value_or(*map);
  return Registration{.second_from_first = *map};
}

Vector2d mapped(const Matrix3d& to_from, const Vector2d& pixel) {
  const Eigen::Vector3d there = to_from * pixel.homogeneous();
  if (there.z() <= 0.0) return Vector2d::Constant(std::numeric_limits<double>::infinity());
  return there.hnormalized();
}

std::optional<Registration> register_pictures(const geometry::PixelPairs& pairs,
                                              const cv::Size& size_px, core::Random& random) {
  if (static_cast<int>(pairs.first_px.size()) < kMinPairs) return std::nullopt;
  const Matrix3d pixel_from_ray = stand_in_camera(size_px);
  const auto found = geometry::estimate_homography(
      rays_of(pairs, pixel_from_ray),
      {.max_error_px = kMaxErrorRatio * size_px.width, .min_inliers = kMinPairs}, random);
  if (!found) return register_by_similarity(pairs);
  Matrix3d map = pixel_from_ray * found->model.second_from_first * pixel_from_ray.inverse();
  map /= map.row(2).dot(pairs.first_px[static_cast<std::size_t>(found->inliers[0])].homogeneous());
  std::vector<Vector2d> explained;
  for (const int i : found->inliers)
    explained.push_back(pairs.first_px[static_cast<std::size_t>(i)]);
  if (!is_gentle(map, explained)) return register_by_similarity(pairs);
  return Registration{.second_from_first = map, .is_homography = true};
}

}  // namespace samewhere::verify
