#pragma once

#include <vector>

#include <samewhere/optimize/bundle.hpp>

namespace samewhere::optimize {

// What both solvers of a bundle minimise: a problem, where its cameras and points are by now, and
// which observations count.
struct BundleState {
  const BundleProblem* problem = nullptr;
  std::vector<core::Rigid3> camera_from_world;   // one per camera
  std::vector<Eigen::Vector3d> points_in_world;  // one per point
  std::vector<bool> is_used;                     // one per observation
};

// What a point behind the camera that sees it counts for, standard deviations: more than any that
// is still believed. A step that takes a few far ones there must not be refused for their sake;
// they are out when it is over.
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
