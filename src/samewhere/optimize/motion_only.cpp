#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include <samewhere/optimize/manifold.hpp>
#include <samewhere/optimize/motion_only.hpp>
#include <samewhere/optimize/reprojection.hpp>

namespace samewhere::optimize {
namespace {

constexpr int kMinInliers = 6;
constexpr double kConverged = 1e-8;

Reprojection reproject_to(const MotionProblem& problem, const MotionObservation& seen,
                          const Eigen::Vector3d& point_in_camera) {
  return reproject(problem.intrinsics, problem.baseline_m, point_in_camera,
                   {seen.undistorted_px, seen.right_x_px, seen.sigma_px});
}

struct NormalEquations {
  core::Matrix6d hessian = core::Matrix6d::Zero();
  core::Vector6d gradient = core::Vector6d::Zero();
};

NormalEquations linearise(const MotionProblem& problem, const MotionResult& result) {
  NormalEquations sum;
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    if (!result.is_inlier[i]) continue;
    const MotionResidual r =
        motion_residual(problem, problem.observations[i], result.camera_from_world);
    if (r.size == 0) continue;
    const double squared = r.value.squaredNorm();
    const double limit = kChiSquare95[r.size];
    const double weight = squared <= limit ? 1.0 : std::sqrt(limit / squared);  // Huber
    sum.hessian += weight * r.jacobian.transpose() * r.jacobian;
    sum.gradient += weight * r.jacobian.transpose() * r.value;
  }
  return sum;
}

void descend(const MotionProblem& problem, MotionResult& result, int iterations) {
  for (int i = 0; i < iterations; ++i) {
    NormalEquations sum = linearise(problem, result);
    // a little damping: a direction without evidence (all points on a line) must not run away
    sum.hessian.diagonal().array() += 1e-6 * sum.hessian.diagonal().array().maxCoeff();
    const Eigen::LDLT<core::Matrix6d> factor(sum.hessian);
    const core::Vector6d step = factor.solve(-sum.gradient);
    if (!step.allFinite()) return;
    result.camera_from_world = retract(result.camera_from_world, step);
    if (step.norm() < kConverged) return;
  }
}

void sort_inliers(const MotionProblem& problem, MotionResult& result) {
  result.num_inliers = 0;
  double sum_squared_px = 0.0;
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    const MotionObservation& seen = problem.observations[i];
    const Reprojection r =
        reproject_to(problem, seen, result.camera_from_world * seen.point_in_world);
    result.is_inlier[i] = is_inlier(r);
    if (!result.is_inlier[i]) continue;
    ++result.num_inliers;
    sum_squared_px += seen.sigma_px * seen.sigma_px * r.value.head<2>().squaredNorm();
  }
  result.reprojection_rmse_px =
      result.num_inliers > 0 ? std::sqrt(sum_squared_px / result.num_inliers) : 0.0;
}

}  // namespace

MotionResidual motion_residual(const MotionProblem& problem, const MotionObservation& observation,
                               const core::Rigid3& camera_from_world) {
  const Eigen::Vector3d rotated = camera_from_world.rotation * observation.point_in_world;
  const Reprojection reprojection =
      reproject_to(problem, observation, rotated + camera_from_world.translation);
  MotionResidual r{reprojection.size, reprojection.value};
  r.jacobian.leftCols<3>() = reprojection.by_point;
  for (int row = 0; row < reprojection.size; ++row) {
    r.jacobian.row(row).tail<3>() = rotated.cross(reprojection.by_point.row(row).transpose());
  }
  return r;
}

MotionResult refine_pose(const MotionProblem& problem, const core::Rigid3& camera_from_world,
                         const Config& config) {
  MotionResult result;
  result.camera_from_world = camera_from_world;
  result.is_inlier.assign(problem.observations.size(), true);
  for (int round = 0; round < config.motion_rounds; ++round) {
    descend(problem, result, config.motion_iterations);
    sort_inliers(problem, result);
    if (result.num_inliers < kMinInliers) {
      result.camera_from_world = camera_from_world;
      break;
    }
  }
  sort_inliers(problem, result);
  return result;
}

}  // namespace samewhere::optimize
