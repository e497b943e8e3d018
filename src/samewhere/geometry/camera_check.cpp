#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/geometry/camera_check.hpp>

namespace samewhere::geometry {
namespace {

using Fault = std::optional<std::string>;

// A coefficient of distortion and the power of the distance from the centre that it goes with.
struct Coefficient {
  std::string_view name;
  double value = 0.0;
  int power = 0;
};

std::vector<Coefficient> coefficients_of(const core::PinholeRadtan& c) {
  return {{"k1", c.k1, 2}, {"k2", c.k2, 4}, {"p1", c.p1, 1}, {"p2", c.p2, 1},
          {"k3", c.k3, 6}, {"k4", c.k4, 2}, {"k5", c.k5, 4}, {"k6", c.k6, 6}};
}

std::vector<Coefficient> coefficients_of(const core::KannalaBrandt& c) {
  return {{"k1", c.k1, 2}, {"k2", c.k2, 4}, {"k3", c.k3, 6}, {"k4", c.k4, 8}};
}

std::vector<Coefficient> coefficients_of(const core::Camera& camera) {
  return std::visit([](const auto& c) { return coefficients_of(c); }, camera);
}

bool is_within(double number, double min, double max) { return number >= min && number <= max; }

bool has_size(const core::Camera& camera) { return (picture_size_px(camera).array() > 0).all(); }

Fault fault_of_size(const core::Camera& camera) {
  const Eigen::Vector2i size_px = picture_size_px(camera);
  const bool is_unknown = size_px.isZero();
  if (is_unknown || (size_px.minCoeff() > 0 && size_px.maxCoeff() <= kMaxPicture_px)) return {};
  return fmt::format("pictures of {} x {} pixels, expected 1 to {}", size_px.x(), size_px.y(),
                     kMaxPicture_px);
}

Fault fault_of_focal_lengths(const core::Camera& camera) {
  const Eigen::Vector2d f_px = focal_lengths_px(camera);
  const double side_px = picture_size_px(camera).maxCoeff();
  const bool is_sized = has_size(camera);
  const double min_px = is_sized ? kMinFocalLength_ratio * side_px : kMinFocalLength_px;
  const double max_px = is_sized ? kMaxFocalLength_ratio * side_px : kMaxFocalLength_px;
  for (const auto& [name, value] : {std::pair("fx", f_px.x()), std::pair("fy", f_px.y())}) {
    if (is_within(value, min_px, max_px)) continue;
    return fmt::format("focal length {} = {} px, expected {} to {} px{}", name, value, min_px,
                       max_px, is_sized ? fmt::format(" on pictures {} px long", side_px) : "");
  }
  const double ratio = f_px.x() / f_px.y();
  if (is_within(ratio, 1.0 / kMaxFocalLengths_ratio, kMaxFocalLengths_ratio)) return {};
  return fmt::format("focal lengths fx = {} and fy = {} px, expected nearly equal ones", f_px.x(),
                     f_px.y());
}

Fault fault_of_centre(const core::Camera& camera) {
  const Eigen::Vector2d c_px = centre_px(camera);
  const Eigen::Vector2i size_px = picture_size_px(camera);
  const Eigen::Vector2d max_px = has_size(camera)
                                     ? Eigen::Vector2d(size_px.x() - 1.0, size_px.y() - 1.0)
                                     : Eigen::Vector2d::Constant(kMaxPicture_px);
  if (is_within(c_px.x(), 0.0, max_px.x()) && is_within(c_px.y(), 0.0, max_px.y())) return {};
  if (!has_size(camera)) {
    return fmt::format("the centre ({}, {}), expected 0 to {} px", c_px.x(), c_px.y(),
                       kMaxPicture_px);
  }
  return fmt::format("the centre ({}, {}) lies outside the image of {} x {} pixels", c_px.x(),
                     c_px.y(), size_px.x(), size_px.y());
}

Fault fault_of_coefficients(const core::Camera& camera) {
  for (const Coefficient& c : coefficients_of(camera)) {
    if (is_within(c.value, -kMaxDistortion, kMaxDistortion)) continue;
    return fmt::format("distortion {} = {}, expected -{} to {}, which no lens exceeds", c.name,
                       c.value, kMaxDistortion, kMaxDistortion);
  }
  return {};
}

// Whether what is seen at the pixel is seen there again.
bool returns(const core::Camera& camera, const Eigen::Vector2d& pixel) {
  constexpr double kMaxError_px = 0.05;
  const Eigen::Vector3d direction = bearing(camera, pixel);
  if (!direction.allFinite()) return false;
  const auto again = project(camera, direction);
  return again && (*again - pixel).norm() <= kMaxError_px;
}

// Share of the pixels of a grid over the picture, its border included, that do not.
double folded_ratio(const core::Camera& camera) {
  constexpr int kGrid = 24;
  const Eigen::Vector2i size_px = picture_size_px(camera);
  int num_folded = 0;
  for (int row = 0; row <= kGrid; ++row) {
    for (int column = 0; column <= kGrid; ++column) {
      const Eigen::Vector2d pixel((size_px.x() - 1.0) * column / kGrid,
                                  (size_px.y() - 1.0) * row / kGrid);
      if (!returns(camera, pixel)) ++num_folded;
    }
  }
  return num_folded / ((kGrid + 1.0) * (kGrid + 1.0));
}

Fault fault_of_mapping(const core::Camera& camera) {
  if (!has_size(camera)) return {};
  const double ratio = folded_ratio(camera);
  if (ratio <= kMaxFolded_ratio) return {};
  const Eigen::Vector2d f_px = focal_lengths_px(camera);
  const Eigen::Vector2d half = 0.5 * picture_size_px(camera).cast<double>();
  const double reach = half.cwiseQuotient(f_px).norm();  // of the corners, focal lengths
  std::vector<Coefficient> all = coefficients_of(camera);
  const auto pull = [&](const Coefficient& c) {
    return std::abs(c.value) * std::pow(reach, c.power);
  };
  const auto strongest = std::max_element(
      all.begin(), all.end(),
      [&](const Coefficient& a, const Coefficient& b) { return pull(a) < pull(b); });
  return fmt::format(
      "distortion {} = {} folds the picture: {:.0f} % of its pixels are seen from no direction or "
      "from several, expected at most {:.0f} %",
      strongest->name, strongest->value, 100.0 * ratio, 100.0 * kMaxFolded_ratio);
}

}  // namespace

std::optional<std::string> fault_of(const core::Camera& camera) {
  for (const auto& check : {&fault_of_size, &fault_of_focal_lengths, &fault_of_centre,
                            &fault_of_coefficients, &fault_of_mapping}) {
    if (Fault fault = check(camera)) return fault;
  }
  return {};
}

}  // namespace samewhere::geometry
