#pragma once

#include <vector>

#include <samewhere/optimize/bundle.hpp>

namespace samewhere::optimize {

// State of a bundle adjustment, for both solvers: the problem, its cameras and points, and the
// observations in use.
struct BundleState {
  const BundleProblem* problem = nullptr;
  std::vector<core::Rigid3> camera_from_world;   // one per camera
  std::vector<Eigen::Vector3d> points_in_world;  // one per point
  std::vector<bool> is_used;                     // one per observation
};

// Error of a point behind the camera that observes it, standard deviations: above that of any
// inlier, but small enough that a step that moves a few distant points there is not rejected; they
// are outliers afterwards.
inline constexpr double kErrorBehind = 100.0;

// Moves free cameras and points towards the least sum of squared reprojection errors, or of their
// Huber losses (`is_robust`); returns the number of iterations. Points that no used observation
// sees stay. Levenberg and Marquardt with Schur elimination of the points, in blocks of 6 and 3
// (Triggs et al. 2000, section 6.1); the damping follows Nielsen (1999). The reduced system is
// dense: meant for some dozens of free cameras.
int minimise_by_schur(BundleState& state, bool is_robust, int max_iterations);

// The same by Ceres, sparse where there are many cameras.
int minimise_by_ceres(BundleState& state, bool is_robust, int max_iterations);

}  // namespace samewhere::optimize
