#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Cholesky>

#include <samewhere/optimize/manifold.hpp>
#include <samewhere/optimize/motion_only.hpp>
#include <samewhere/optimize/reprojection.hpp>

namespace samewhere::optimize {
namespace {

constexpr double kConverged = 1e-8;
constexpr int kPoseNumbers = 6;
constexpr double kCell = 0.15;         // side of a cell of the image, tangent of an angle
constexpr double kMinVariance = 1e-4;  // of a residual: no image is without noise

Reprojection reproject_to(const MotionProblem& problem, const MotionObservation& seen,
                          const Eigen::Vector3d& point_in_camera) {
  return reproject(problem.intrinsics, problem.baseline_m, point_in_camera,
                   {seen.undistorted_px, seen.right_x_px, seen.sigma_px});
}

struct NormalEquations {
  core::Matrix6d hessian = core::Matrix6d::Zero();
  core::Vector6d gradient = core::Vector6d::Zero();
};

// visit(observation, residual, its weight) for each inlier in front of the camera.
template <class Visit>
void for_each_inlier(const MotionProblem& problem, const MotionResult& result, const Visit& visit) {
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    if (!result.is_inlier[i]) continue;
    const MotionResidual r =
        motion_residual(problem, problem.observations[i], result.camera_from_world);
    if (r.size == 0) continue;
    const double squared = r.value.squaredNorm();
    const double limit = kChiSquare95[r.size];
    const double weight = squared <= limit ? 1.0 : std::sqrt(limit / squared);  // Huber
    visit(problem.observations[i], r, weight);
  }
}

NormalEquations linearise(const MotionProblem& problem, const MotionResult& result) {
  NormalEquations sum;
  for_each_inlier(problem, result, [&](const auto&, const MotionResidual& r, double weight) {
    sum.hessian += weight * r.jacobian.transpose() * r.jacobian;
    sum.gradient += weight * r.jacobian.transpose() * r.value;
  });
  return sum;
}

// a little damping: a direction that no point constrains (all on a line) must not diverge
core::Matrix6d damped(core::Matrix6d hessian) {
  hessian.diagonal().array() += 1e-6 * hessian.diagonal().array().maxCoeff();
  return hessian;
}

void descend(const MotionProblem& problem, MotionResult& result, int iterations) {
  for (int i = 0; i < iterations; ++i) {
    const NormalEquations sum = linearise(problem, result);
    const Eigen::LDLT<core::Matrix6d> factor(damped(sum.hessian));
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

using Cell = std::pair<int, int>;

Cell cell_of(const MotionProblem& problem, const MotionObservation& seen) {
  const core::PinholeRadtan& camera = problem.intrinsics;
  const auto index = [](double tangent) { return static_cast<int>(std::floor(tangent / kCell)); };
  return {index((seen.undistorted_px.x() - camera.cx_px) / camera.fx_px),
          index((seen.undistorted_px.y() - camera.cy_px) / camera.fy_px)};
}

core::Matrix6d covariance_of(const MotionProblem& problem, const MotionResult& result) {
  core::Matrix6d hessian = core::Matrix6d::Zero();
  double squares = 0.0;
  int num_spare = -kPoseNumbers;
  std::map<Cell, core::Vector6d> gradients;  // of the residuals of a cell
  for_each_inlier(problem, result, [&](const auto& seen, const MotionResidual& r, double weight) {
    hessian += weight * r.jacobian.transpose() * r.jacobian;
    squares += weight * r.value.squaredNorm();
    num_spare += r.size;
    const auto cell = gradients.try_emplace(cell_of(problem, seen), core::Vector6d::Zero()).first;
    cell->second += weight * r.jacobian.transpose() * r.value;
  });
  core::Matrix6d spread = std::max(squares / std::max(num_spare, 1), kMinVariance) * hessian;
  for (const auto& [cell, gradient] : gradients) spread += gradient * gradient.transpose();
  const core::Matrix6d inverse = damped(hessian).ldlt().solve(core::Matrix6d::Identity());
  return inverse * spread * inverse;
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
    if (result.num_inliers < config.motion_min_inliers) {
      result.camera_from_world = camera_from_world;
      break;
    }
  }
  sort_inliers(problem, result);
  if (result.num_inliers >= config.motion_min_inliers)
    result.covariance = covariance_of(problem, result);
  return result;
}

}  // namespace samewhere::optimize
