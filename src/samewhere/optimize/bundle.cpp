#include <algorithm>
#include <cmath>

#include <samewhere/core/errors.hpp>
#include <samewhere/optimize/bundle.hpp>
#include <samewhere/optimize/pose_block.hpp>

namespace samewhere::optimize {
namespace {

constexpr std::size_t kPoseSize = 7;
constexpr std::size_t kPointSize = 3;
constexpr std::ptrdiff_t kMaxDenseCameras = 60;  // beyond, the Schur complement is mostly zeros

// Size 2 without depth, 3 with.
template <int Size>
class ReprojectionCost : public ceres::SizedCostFunction<Size, kPoseSize, kPointSize> {
 public:
  ReprojectionCost(const BundleCamera& camera, const SeenAt& seen) : camera_(camera), seen_(seen) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const BundleResidual r = bundle_residual(camera_, from_block(blocks[0]),
                                             Eigen::Map<const Eigen::Vector3d>(blocks[1]), seen_);
    if (r.reprojection.size == 0) return false;  // a step that takes a point behind a camera
    Eigen::Map<Eigen::Matrix<double, Size, 1>>{residuals} = r.reprojection.value.head<Size>();
    if (jacobians == nullptr) return true;
    write_by_tangent<Size>(r.by_pose.topRows<Size>(), jacobians[0]);
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, Size, 3, Eigen::RowMajor>>{jacobians[1]} =
          r.by_point.topRows<Size>();
    }
    return true;
  }

 private:
  const BundleCamera& camera_;  // of the problem, which outlives the solver
  const SeenAt& seen_;
};

bool has_depth(const BundleObservation& observation) {
  return std::isfinite(observation.seen.right_x_px);
}

// One bundle while it is solved. All parameter blocks lie in one array, poses before points, so
// that their order, and with it every sum, is the same in each run.
class Bundle {
 public:
  explicit Bundle(const BundleProblem& problem) : problem_(problem) {
    for (const auto& camera : problem.cameras) {
      const PoseBlock block = to_block(camera.camera_from_world);
      parameters_.insert(parameters_.end(), block.begin(), block.end());
    }
    for (const auto& point : problem.points_in_world)
      parameters_.insert(parameters_.end(), point.data(), point.data() + kPointSize);
    sort_inliers();
    // at first only what has no reprojection at all is out: poses are still wrong
    for (std::size_t i = 0; i < problem.observations.size(); ++i)
      is_used_[i] = residual(i).reprojection.size > 0;
  }

  void use_inliers() {
    sort_inliers();
    is_used_ = result_.is_inlier;
  }

  void solve(bool is_robust, int max_iterations);

  BundleResult result() {
    sort_inliers();
    for (std::size_t i = 0; i < problem_.cameras.size(); ++i) {
      const bool is_fixed = problem_.cameras[i].is_fixed;
      result_.camera_from_world.push_back(is_fixed ? problem_.cameras[i].camera_from_world
                                                   : from_block(pose(i)));
    }
    for (std::size_t i = 0; i < problem_.points_in_world.size(); ++i)
      result_.points_in_world.emplace_back(Eigen::Map<const Eigen::Vector3d>(point(i)));
    return result_;
  }

 private:
  double* pose(std::size_t camera) { return &parameters_[kPoseSize * camera]; }
  double* point(std::size_t i) {
    return &parameters_[kPoseSize * problem_.cameras.size() + kPointSize * i];
  }

  BundleResidual residual(std::size_t i) {
    const BundleObservation& o = problem_.observations[i];
    const auto camera = static_cast<std::size_t>(o.camera);
    const Eigen::Map<const Eigen::Vector3d> where(point(static_cast<std::size_t>(o.point)));
    return bundle_residual(problem_.cameras[camera], from_block(pose(camera)), where, o.seen);
  }

  void sort_inliers() {
    const std::size_t n = problem_.observations.size();
    result_.is_inlier.resize(n);
    is_used_.resize(n);
    for (std::size_t i = 0; i < n; ++i) result_.is_inlier[i] = is_inlier(residual(i).reprojection);
  }

  // Points whose used observations fix them: one with depth, or two.
  std::vector<bool> supported_points() const {
    std::vector<int> support(problem_.points_in_world.size(), 0);
    for (std::size_t i = 0; i < problem_.observations.size(); ++i) {
      const BundleObservation& o = problem_.observations[i];
      if (is_used_[i]) support[static_cast<std::size_t>(o.point)] += has_depth(o) ? 2 : 1;
    }
    std::vector<bool> is_supported;
    for (const int n : support) is_supported.push_back(n >= 2);
    return is_supported;
  }

  void add_observations(ceres::Problem& problem, bool is_robust);

  const BundleProblem& problem_;
  std::vector<double> parameters_;
  std::vector<bool> is_used_;  // one per observation
  BundleResult result_;
  PoseManifold manifold_;
  ceres::HuberLoss huber_2_{std::sqrt(kChiSquare95[2])};
  ceres::HuberLoss huber_3_{std::sqrt(kChiSquare95[3])};
};

void Bundle::add_observations(ceres::Problem& problem, bool is_robust) {
  const std::vector<bool> is_supported = supported_points();
  for (std::size_t i = 0; i < problem_.observations.size(); ++i) {
    const BundleObservation& o = problem_.observations[i];
    const auto camera = static_cast<std::size_t>(o.camera);
    const auto seen_point = static_cast<std::size_t>(o.point);
    if (!is_used_[i] || !is_supported[seen_point]) continue;
    const BundleCamera& from = problem_.cameras[camera];
    ceres::CostFunction* cost = nullptr;
    if (has_depth(o)) {
      cost = new ReprojectionCost<3>(from, o.seen);
    } else {
      cost = new ReprojectionCost<2>(from, o.seen);
    }
    ceres::LossFunction* loss = has_depth(o) ? &huber_3_ : &huber_2_;
    problem.AddResidualBlock(cost, is_robust ? loss : nullptr, pose(camera), point(seen_point));
  }
}

// One thread and Eigen's solvers, as for the pose graph; see there.
ceres::Solver::Options solver_options(int max_iterations, std::ptrdiff_t num_free_cameras) {
  ceres::Solver::Options options;
  options.linear_solver_type =
      num_free_cameras <= kMaxDenseCameras ? ceres::DENSE_SCHUR : ceres::SPARSE_SCHUR;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.dense_linear_algebra_library_type = ceres::EIGEN;
  options.num_threads = 1;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-5;
  options.logging_type = ceres::SILENT;
  return options;
}

void Bundle::solve(bool is_robust, int max_iterations) {
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  const auto& cameras = problem_.cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    problem.AddParameterBlock(pose(i), kPoseSize, &manifold_);
    if (cameras[i].is_fixed) problem.SetParameterBlockConstant(pose(i));
  }
  for (std::size_t i = 0; i < problem_.points_in_world.size(); ++i)
    problem.AddParameterBlock(point(i), kPointSize);
  add_observations(problem, is_robust);
  if (problem.NumResidualBlocks() == 0) return;

  const auto num_free = std::count_if(cameras.begin(), cameras.end(),
                                      [](const BundleCamera& camera) { return !camera.is_fixed; });
  ceres::Solver::Options options = solver_options(max_iterations, num_free);
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (std::size_t i = 0; i < problem_.points_in_world.size(); ++i)
    ordering->AddElementToGroup(point(i), 0);
  for (std::size_t i = 0; i < cameras.size(); ++i) ordering->AddElementToGroup(pose(i), 1);
  options.linear_solver_ordering = ordering;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  result_.num_iterations += static_cast<int>(summary.iterations.size());
}

void check(const BundleProblem& problem) {
  const auto is_position = [](int i, std::size_t size) {
    return i >= 0 && static_cast<std::size_t>(i) < size;
  };
  core::require(std::any_of(problem.cameras.begin(), problem.cameras.end(),
                            [](const BundleCamera& camera) { return camera.is_fixed; }),
                "a bundle has a fixed camera that holds it in place");
  for (const auto& o : problem.observations) {
    core::require(is_position(o.camera, problem.cameras.size()) &&
                      is_position(o.point, problem.points_in_world.size()),
                  "an observation joins a camera and a point of the bundle");
  }
}

}  // namespace

BundleResidual bundle_residual(const BundleCamera& camera, const core::Rigid3& camera_from_world,
                               const Eigen::Vector3d& point_in_world, const SeenAt& seen) {
  const Eigen::Matrix3d rotation = camera_from_world.rotation.toRotationMatrix();
  const Eigen::Vector3d rotated = rotation * point_in_world;
  BundleResidual r;
  r.reprojection = reproject(camera.intrinsics, camera.baseline_m,
                             rotated + camera_from_world.translation, seen);
  r.by_pose.leftCols<3>() = r.reprojection.by_point;
  r.by_pose.rightCols<3>() = -r.reprojection.by_point * core::skew(rotated);
  r.by_point = r.reprojection.by_point * rotation;
  return r;
}

BundleResult solve_bundle(const BundleProblem& problem, const Config& config) {
  check(problem);
  Bundle bundle(problem);
  bundle.solve(true, config.bundle_iterations);
  bundle.use_inliers();
  bundle.solve(false, config.bundle_iterations);
  return bundle.result();
}

}  // namespace samewhere::optimize
