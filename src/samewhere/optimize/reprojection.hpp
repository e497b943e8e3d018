#pragma once

#include <cmath>

#include <Eigen/Core>

#include <samewhere/core/rig.hpp>

namespace samewhere::optimize {

// Points nearer to the camera's plane have no reprojection.
constexpr double kMinDepth_m = 0.05;

// 95 % points of chi-square by degrees of freedom: beyond, a reprojection is an outlier.
constexpr double kChiSquare95[] = {0.0, 0.0, 5.991, 7.815};

// Pixel at which an image shows a point.
struct SeenAt {
  Eigen::Vector2d undistorted_px = Eigen::Vector2d::Zero();
  double right_x_px = 0.0;  // (virtual) right image; NaN = no depth
  double sigma_px = 1.0;    // standard deviation of the coordinates
};

// Residual [x, y, right x] (px, divided by sigma) and its derivative by the point in the camera's
// frame. `size` is 3 with depth, 2 without (the last row is zero then), 0 for a point that is not
// in front of the camera.
struct Reprojection {
  int size = 0;
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Matrix3d by_point = Eigen::Matrix3d::Zero();
};

// `baseline_m` is that of the (virtual) stereo pair; distortion of the intrinsics is not used.
inline Reprojection reproject(const core::PinholeRadtan& intrinsics, double baseline_m,
                              const Eigen::Vector3d& point_in_camera, const SeenAt& seen) {
  Reprojection r;
  const Eigen::Vector3d& p = point_in_camera;
  if (p.z() < kMinDepth_m) return r;

  const core::PinholeRadtan& c = intrinsics;
  const double inverse_z = 1.0 / p.z();
  const double x = c.fx_px * p.x() * inverse_z + c.cx_px;
  const double y = c.fy_px * p.y() * inverse_z + c.cy_px;
  const double disparity = c.fx_px * baseline_m * inverse_z;
  const bool has_depth = std::isfinite(seen.right_x_px);
  r.size = has_depth ? 3 : 2;
  r.value << x - seen.undistorted_px.x(), y - seen.undistorted_px.y(),
      has_depth ? x - disparity - seen.right_x_px : 0.0;

  r.by_point.row(0) << c.fx_px * inverse_z, 0.0, -c.fx_px * p.x() * inverse_z * inverse_z;
  r.by_point.row(1) << 0.0, c.fy_px * inverse_z, -c.fy_px * p.y() * inverse_z * inverse_z;
  if (has_depth) {
    r.by_point.row(2) = r.by_point.row(0);
    r.by_point(2, 2) += disparity * inverse_z;
  }
  r.value /= seen.sigma_px;
  r.by_point /= seen.sigma_px;
  return r;
}

// Whether the residual is within the chi-square limit.
inline bool is_inlier(const Reprojection& r) {
  return r.size > 0 && r.value.squaredNorm() < kChiSquare95[r.size];
}

}  // namespace samewhere::optimize
