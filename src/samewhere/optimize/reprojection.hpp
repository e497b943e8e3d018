#pragma once

#include <Eigen/Core>

#include <samewhere/core/rig.hpp>

namespace samewhere::optimize {

// Nearer to the camera's plane than this, a point has no reprojection.
constexpr double kMinDepth_m = 0.05;

// 95 % points of chi-square by degrees of freedom: beyond, a reprojection is an outlier.
constexpr double kChiSquare95[] = {0.0, 0.0, 5.991, 7.815};

// Where a picture shows a point.
struct SeenAt {
  Eigen::Vector2d undistorted_px = Eigen::Vector2d::Zero();
  double right_x_px = 0.0;  // (virtual) right picture; NaN = no depth
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
Reprojection reproject(const core::PinholeRadtan& intrinsics, double baseline_m,
                       const Eigen::Vector3d& point_in_camera, const SeenAt& seen);

// Whether the point may be what is seen there.
inline bool is_inlier(const Reprojection& r) {
  return r.size > 0 && r.value.squaredNorm() < kChiSquare95[r.size];
}

}  // namespace samewhere::optimize
