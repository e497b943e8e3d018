#pragma once

#include <vector>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/optimize/config.hpp>
#include <samewhere/optimize/reprojection.hpp>

namespace samewhere::optimize {

struct BundleCamera {
  core::Rigid3 camera_from_world;
  core::PinholeRadtan intrinsics;  // distortion is not used
  double baseline_m = 0.0;         // of the (virtual) stereo pair
  bool is_fixed = false;
};

// Camera `camera` sees point `point` (positions in the problem).
struct BundleObservation {
  int camera = 0;
  int point = 0;
  SeenAt seen;
};

struct BundleProblem {
  std::vector<BundleCamera> cameras;
  std::vector<Eigen::Vector3d> points_in_world;  // metres
  std::vector<BundleObservation> observations;
};

struct BundleResult {
  std::vector<core::Rigid3> camera_from_world;  // one per camera; fixed ones as they were
  std::vector<Eigen::Vector3d>
      points_in_world;          // one per point; those without support as they were
  std::vector<bool> is_inlier;  // one per observation, at the result: chi-square at 95 %
  int num_iterations = 0;       // both rounds
};

// Poses and points that minimise the reprojection errors, eq. (23) as a sum of squares. Two rounds
// of Levenberg and Marquardt with Schur elimination of the points (Triggs et al. 2000): with a
// Huber loss, then without it on the inliers of the first. A point with a single observation and no
// depth does not constrain the poses: it is left out and stays; so does a camera with fewer than
// Config::bundle_min_observations inliers in the first round. Without a free camera only the points
// move. The caller fixes the gauge: one camera, or two where no observation has depth. Throws
// ContractError without any fixed camera, and for an observation of a camera or point that is not
// there.
BundleResult solve_bundle(const BundleProblem& problem, const Config& config);

// Reprojection of one observation with its derivatives by retract() at the camera's pose and by the
// point in the world.
struct BundleResidual {
  Reprojection reprojection;
  Eigen::Matrix<double, 3, 6> by_pose = Eigen::Matrix<double, 3, 6>::Zero();
  Eigen::Matrix3d by_point = Eigen::Matrix3d::Zero();
};

BundleResidual bundle_residual(const BundleCamera& camera, const core::Rigid3& camera_from_world,
                               const Eigen::Vector3d& point_in_world, const SeenAt& seen);

}  // namespace samewhere::optimize
