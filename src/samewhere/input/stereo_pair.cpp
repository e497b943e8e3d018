#include <array>
#include <cmath>
#include <optional>

#include <Eigen/LU>
#include <fmt/format.h>

#include <samewhere/input/stereo_pair.hpp>

namespace samewhere::input {
namespace {

std::optional<core::Rigid3> rectified_from_raw(const messages::CameraInfo& info) {
  constexpr double kTolerance = 0.01;
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> r(info.r.data());
  if (r.isZero()) return core::Rigid3{};
  const double deviation = (r * r.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (!(deviation < kTolerance) || r.determinant() < 0.0) return std::nullopt;
  return core::Rigid3{.rotation = Eigen::Quaterniond(Eigen::Matrix3d(r)).normalized()};
}

}  // namespace

Result<core::Rigid3, std::string> left_from_right(const messages::CameraInfo& left,
                                                  const messages::CameraInfo& right,
                                                  bool is_rectified) {
  const double baseline_m = right.p[0] == 0.0 ? 0.0 : -right.p[3] / right.p[0];
  if (!std::isfinite(baseline_m) || baseline_m == 0.0) {
    return refuse(
        fmt::format("P[3] of the right camera is {}; expected minus the focal length times the "
                    "baseline, in metres",
                    right.p[3]));
  }
  const core::Rigid3 rectified_left_from_right{.translation = {baseline_m, 0.0, 0.0}};
  if (is_rectified) return rectified_left_from_right;
  const auto rectified_from_left = rectified_from_raw(left);
  const auto rectified_from_right = rectified_from_raw(right);
  if (!rectified_from_left || !rectified_from_right) {
    return refuse(
        fmt::format("R of the {} camera is no rotation", rectified_from_left ? "right" : "left"));
  }
  return core::inverse(*rectified_from_left) * rectified_left_from_right * *rectified_from_right;
}

}  // namespace samewhere::input
