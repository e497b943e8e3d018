#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

#include <samewhere/core/rig.hpp>
#include <samewhere/optimize/config.hpp>

namespace samewhere::optimize {

// Observation of a point of known position.
struct MotionObservation {
  Eigen::Vector3d point_in_world = Eigen::Vector3d::Zero();  // metres
  Eigen::Vector2d undistorted_px = Eigen::Vector2d::Zero();
  double right_x_px =
      std::numeric_limits<double>::quiet_NaN();  // virtual right image; NaN = no depth
  double sigma_px = 1.0;                         // standard deviation of the pixel coordinates
};

struct MotionProblem {
  core::PinholeRadtan intrinsics;  // distortion is not used
  double baseline_m = 0.0;         // of the (virtual) stereo pair
  std::vector<MotionObservation> observations;
};

struct MotionResult {
  core::Rigid3 camera_from_world;
  std::vector<bool> is_inlier;  // one per observation
  int num_inliers = 0;
  double reprojection_rmse_px =
      0.0;  // of the inliers, without the right image; 0 if there are none
  // Of the pose by retract(), from the residuals of the inliers, not from sigma_px: the sum of the
  // covariance for independent residuals and of that for residuals correlated within a cell of the
  // image (sandwich estimate over clusters; Liang and Zeger, Biometrika 1986). The points are taken
  // as known. Identity with too few inliers.
  core::Matrix6d covariance = core::Matrix6d::Identity();
};

// The pose that minimises the reprojection error of the points, which stay fixed. Gauss-Newton with
// Huber weights; after each round the observations are classified as inliers or outliers at the
// 95 % point of chi-square, and outliers are not used in the next round. With fewer than
// Config::motion_min_inliers inliers the pose returned is the initial one.
MotionResult refine_pose(const MotionProblem& problem, const core::Rigid3& camera_from_world,
                         const Config& config);

// Residual [x, y, right x] (px, divided by sigma) of one observation and its derivative by
// retract() at the pose. `size` is 3 with depth, 2 without, 0 for a point that is not in front of
// the camera.
struct MotionResidual {
  int size = 0;
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, 6> jacobian = Eigen::Matrix<double, 3, 6>::Zero();
};

MotionResidual motion_residual(const MotionProblem& problem, const MotionObservation& observation,
                               const core::Rigid3& camera_from_world);

}  // namespace samewhere::optimize
