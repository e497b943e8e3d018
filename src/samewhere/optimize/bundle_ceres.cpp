#include <algorithm>
#include <cmath>

#include <samewhere/optimize/pose_block.hpp>
#include <samewhere/optimize/schur.hpp>

namespace samewhere::optimize {
namespace {

// Size 2 without depth, 3 with.
template <int Size>
class ReprojectionCost : public ceres::SizedCostFunction<Size, kPoseSize, kPointSize> {
 public:
  ReprojectionCost(const BundleCamera& camera, const SeenAt& seen) : camera_(camera), seen_(seen) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const BundleResidual r = bundle_residual(camera_, from_block(blocks[0]),
                                             Eigen::Map<const Eigen::Vector3d>(blocks[1]), seen_);
    Eigen::Map<Eigen::Matrix<double, Size, 1>> residual{residuals};
    residual = r.reprojection.value.head<Size>();
    if (r.reprojection.size == 0) residual(0) = kErrorBehind;
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

// One bundle while it is solved. All parameter blocks lie in one array, poses before points, so
// that their order, and with it every sum, is the same in each run.
class CeresBundle {
 public:
  explicit CeresBundle(const BundleState& state) : num_cameras_(state.camera_from_world.size()) {
    for (const auto& pose : state.camera_from_world) {
      const PoseBlock block = to_block(pose);
      parameters_.insert(parameters_.end(), block.begin(), block.end());
    }
    for (const auto& point : state.points_in_world)
      parameters_.insert(parameters_.end(), point.data(), point.data() + kPointSize);
  }

  int minimise(BundleState& state, bool is_robust, int max_iterations);

 private:
  double* pose(std::size_t camera) { return &parameters_[kPoseSize * camera]; }
  double* point(std::size_t i) { return &parameters_[kPoseSize * num_cameras_ + kPointSize * i]; }
  void add_parameters(ceres::Problem& problem, const BundleState& state);
  void add_observations(ceres::Problem& problem, const BundleState& state, bool is_robust);

  std::size_t num_cameras_;
  std::vector<double> parameters_;
  PoseManifold manifold_;
  ceres::HuberLoss huber_2_{std::sqrt(kChiSquare95[2])};
  ceres::HuberLoss huber_3_{std::sqrt(kChiSquare95[3])};
};

void CeresBundle::add_parameters(ceres::Problem& problem, const BundleState& state) {
  for (std::size_t i = 0; i < num_cameras_; ++i) {
    problem.AddParameterBlock(pose(i), kPoseSize, &manifold_);
    if (state.problem->cameras[i].is_fixed) problem.SetParameterBlockConstant(pose(i));
  }
  for (std::size_t i = 0; i < state.points_in_world.size(); ++i)
    problem.AddParameterBlock(point(i), kPointSize);
}

void CeresBundle::add_observations(ceres::Problem& problem, const BundleState& state,
                                   bool is_robust) {
  for (std::size_t i = 0; i < state.is_used.size(); ++i) {
    if (!state.is_used[i]) continue;
    const BundleObservation& o = state.problem->observations[i];
    const auto camera = static_cast<std::size_t>(o.camera);
    const BundleCamera& from = state.problem->cameras[camera];
    const bool has_depth = std::isfinite(o.seen.right_x_px);
    ceres::CostFunction* cost = nullptr;
    if (has_depth) {
      cost = new ReprojectionCost<3>(from, o.seen);
    } else {
      cost = new ReprojectionCost<2>(from, o.seen);
    }
    ceres::LossFunction* loss = has_depth ? &huber_3_ : &huber_2_;
    problem.AddResidualBlock(cost, is_robust ? loss : nullptr, pose(camera),
                             point(static_cast<std::size_t>(o.point)));
  }
}

// One thread and Eigen's solvers, as for the pose graph; see there.
ceres::Solver::Options solver_options(int max_iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_SCHUR;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.num_threads = 1;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-5;
  options.logging_type = ceres::SILENT;
  return options;
}

int CeresBundle::minimise(BundleState& state, bool is_robust, int max_iterations) {
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  add_parameters(problem, state);
  add_observations(problem, state, is_robust);
  if (problem.NumResidualBlocks() == 0) return 0;

  ceres::Solver::Options options = solver_options(max_iterations);
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (std::size_t i = 0; i < state.points_in_world.size(); ++i)
    ordering->AddElementToGroup(point(i), 0);
  for (std::size_t i = 0; i < num_cameras_; ++i) ordering->AddElementToGroup(pose(i), 1);
  options.linear_solver_ordering = ordering;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  for (std::size_t i = 0; i < num_cameras_; ++i) {
    if (!state.problem->cameras[i].is_fixed) state.camera_from_world[i] = from_block(pose(i));
  }
  for (std::size_t i = 0; i < state.points_in_world.size(); ++i)
    state.points_in_world[i] = Eigen::Map<const Eigen::Vector3d>(point(i));
  return static_cast<int>(summary.iterations.size());
}

}  // namespace

int minimise_by_ceres(BundleState& state, bool is_robust, int max_iterations) {
  return CeresBundle(state).minimise(state, is_robust, max_iterations);
}

}  // namespace samewhere::optimize
