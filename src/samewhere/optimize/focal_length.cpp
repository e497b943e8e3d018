#include <algorithm>
#include <cmath>
#include <vector>

#include <samewhere/core/errors.hpp>
#include <samewhere/optimize/focal_length.hpp>
#include <samewhere/optimize/pose_block.hpp>

namespace samewhere::optimize {
namespace {

constexpr std::size_t kMinFocalObservations = 200;

// Of one observation, by the pose, the point and the logarithm of found / assumed focal length.
class FocalCost : public ceres::SizedCostFunction<2, kPoseSize, kPointSize, 1> {
 public:
  FocalCost(const BundleCamera& camera, const SeenAt& seen) : camera_(camera), seen_(seen) {
    seen_.right_x_px = std::nan("");
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    BundleCamera camera = camera_;
    camera.intrinsics.fx_px *= std::exp(blocks[2][0]);
    camera.intrinsics.fy_px *= std::exp(blocks[2][0]);
    const BundleResidual r = bundle_residual(camera, from_block(blocks[0]),
                                             Eigen::Map<const Eigen::Vector3d>(blocks[1]), seen_);
    Eigen::Map<Eigen::Vector2d> residual(residuals);
    residual = r.reprojection.value.head<2>();
    constexpr double kErrorBehind = 10.0;
    if (r.reprojection.size == 0) residual(0) = kErrorBehind;
    if (jacobians == nullptr) return true;
    write_by_tangent<2>(r.by_pose.topRows<2>(), jacobians[0]);
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>>{jacobians[1]} =
          r.by_point.topRows<2>();
    }
    if (jacobians[2] != nullptr) {
      // the pixel's distance from the centre grows as the focal length does
      const Eigen::Vector2d centre(camera.intrinsics.cx_px, camera.intrinsics.cy_px);
      Eigen::Map<Eigen::Vector2d> by_log(jacobians[2]);
      by_log = residual + (seen_.undistorted_px - centre) / seen_.sigma_px;
      if (r.reprojection.size == 0) by_log.setZero();
    }
    return true;
  }

 private:
  BundleCamera camera_;
  SeenAt seen_;
};

class PriorCost : public ceres::SizedCostFunction<1, 1> {
 public:
  explicit PriorCost(double sigma) : sigma_(sigma) {}
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    residuals[0] = blocks[0][0] / sigma_;
    if (jacobians != nullptr && jacobians[0] != nullptr) jacobians[0][0] = 1.0 / sigma_;
    return true;
  }

 private:
  double sigma_;
};

// All parameter blocks in one array, poses before points before the focal length.
class FocalBundle {
 public:
  explicit FocalBundle(const BundleProblem& problem) : problem_(problem) {
    for (const BundleCamera& camera : problem.cameras) {
      const PoseBlock block = to_block(camera.camera_from_world);
      parameters_.insert(parameters_.end(), block.begin(), block.end());
    }
    for (const auto& point : problem.points_in_world)
      parameters_.insert(parameters_.end(), point.data(), point.data() + kPointSize);
    parameters_.push_back(0.0);
  }

  double& log_ratio() { return parameters_.back(); }

  // Half the sum of squares at the least, with the focal length free or held.
  double minimise(double prior_sigma, bool is_free);

 private:
  double* pose(std::size_t camera) { return &parameters_[kPoseSize * camera]; }
  double* point(std::size_t i) {
    return &parameters_[kPoseSize * problem_.cameras.size() + kPointSize * i];
  }
  void fill(ceres::Problem& problem, double prior_sigma, bool is_free);

  const BundleProblem& problem_;
  std::vector<double> parameters_;
  PoseManifold manifold_;
  ceres::HuberLoss huber_{std::sqrt(kChiSquare95[2])};
};

void FocalBundle::fill(ceres::Problem& problem, double prior_sigma, bool is_free) {
  for (std::size_t i = 0; i < problem_.cameras.size(); ++i) {
    problem.AddParameterBlock(pose(i), kPoseSize, &manifold_);
    if (problem_.cameras[i].is_fixed) problem.SetParameterBlockConstant(pose(i));
  }
  problem.AddParameterBlock(&log_ratio(), 1);
  if (!is_free) problem.SetParameterBlockConstant(&log_ratio());
  for (const BundleObservation& o : problem_.observations) {
    const auto camera = static_cast<std::size_t>(o.camera);
    problem.AddResidualBlock(new FocalCost(problem_.cameras[camera], o.seen), &huber_, pose(camera),
                             point(static_cast<std::size_t>(o.point)), &log_ratio());
  }
  problem.AddResidualBlock(new PriorCost(prior_sigma), nullptr, &log_ratio());
}

double FocalBundle::minimise(double prior_sigma, bool is_free) {
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  fill(problem, prior_sigma, is_free);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_SCHUR;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.num_threads = 1;
  options.max_num_iterations = 60;
  options.function_tolerance = 1e-7;
  options.logging_type = ceres::SILENT;
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (std::size_t i = 0; i < problem_.points_in_world.size(); ++i) {
    if (problem.HasParameterBlock(point(i))) ordering->AddElementToGroup(point(i), 0);
  }
  for (std::size_t i = 0; i < problem_.cameras.size(); ++i) ordering->AddElementToGroup(pose(i), 1);
  ordering->AddElementToGroup(&log_ratio(), 1);
  options.linear_solver_ordering = ordering;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.final_cost;
}

}  // namespace

std::optional<FocalLengthFit> fit_focal_length(const BundleProblem& problem, double prior_sigma) {
  const bool is_held = std::any_of(problem.cameras.begin(), problem.cameras.end(),
                                   [](const BundleCamera& camera) { return camera.is_fixed; });
  core::require(is_held || problem.cameras.empty(), "a bundle has a fixed camera");
  if (problem.observations.size() < kMinFocalObservations) return std::nullopt;
  FocalBundle bundle(problem);
  const double least = bundle.minimise(prior_sigma, true);
  const double found = bundle.log_ratio();
  // the cost is a parabola about its minimum; its curvature is the inverse variance
  constexpr double kStep = 0.03;
  bundle.log_ratio() = found + kStep;
  const double rise = bundle.minimise(prior_sigma, false) - least;
  if (!std::isfinite(found) || !(rise > 0.0)) return std::nullopt;
  const double num_spare = 2.0 * static_cast<double>(problem.observations.size()) -
                           6.0 * static_cast<double>(problem.cameras.size()) -
                           3.0 * static_cast<double>(problem.points_in_world.size());
  const double variance = 2.0 * least / std::max(num_spare, 1.0);  // of a residual
  const double ratio = std::exp(found);
  return FocalLengthFit{ratio, ratio * kStep * std::sqrt(variance / (2.0 * rise))};
}

}  // namespace samewhere::optimize
