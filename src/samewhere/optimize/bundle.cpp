#include <algorithm>
#include <cmath>

#include <samewhere/core/errors.hpp>
#include <samewhere/optimize/schur.hpp>

namespace samewhere::optimize {
namespace {

constexpr std::ptrdiff_t kMaxDenseCameras = 60;  // beyond, the reduced system is mostly zeros

BundleResidual residual(const BundleState& state, const BundleObservation& o) {
  const auto camera = static_cast<std::size_t>(o.camera);
  return bundle_residual(state.problem->cameras[camera], state.camera_from_world[camera],
                         state.points_in_world[static_cast<std::size_t>(o.point)], o.seen);
}

std::vector<bool> inliers(const BundleState& state) {
  std::vector<bool> are_inliers;
  for (const auto& o : state.problem->observations)
    are_inliers.push_back(is_inlier(residual(state, o).reprojection));
  return are_inliers;
}

// Points in front of the camera: the first round has no other outliers, since poses are still
// wrong.
std::vector<bool> visible(const BundleState& state) {
  std::vector<bool> are_visible;
  for (const auto& o : state.problem->observations)
    are_visible.push_back(residual(state, o).reprojection.size > 0);
  return are_visible;
}

// Leaves out points that the used observations do not determine: one with depth does, or two.
std::vector<bool> of_supported_points(const BundleProblem& problem, std::vector<bool> is_used) {
  std::vector<int> support(problem.points_in_world.size(), 0);
  const auto& observations = problem.observations;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (!is_used[i]) continue;
    const bool has_depth = std::isfinite(observations[i].seen.right_x_px);
    support[static_cast<std::size_t>(observations[i].point)] += has_depth ? 2 : 1;
  }
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (support[static_cast<std::size_t>(observations[i].point)] < 2) is_used[i] = false;
  }
  return is_used;
}

// Leaves out cameras with too few used observations, which do not determine the pose; they keep
// their initial pose.
std::vector<bool> of_held_cameras(BundleState& state, std::vector<bool> is_used,
                                  int min_observations) {
  const auto& cameras = state.problem->cameras;
  const auto& observations = state.problem->observations;
  std::vector<int> num_used(cameras.size(), 0);
  for (std::size_t i = 0; i < observations.size(); ++i)
    num_used[static_cast<std::size_t>(observations[i].camera)] += is_used[i] ? 1 : 0;
  const auto is_held = [&](std::size_t camera) {
    return cameras[camera].is_fixed || num_used[camera] >= min_observations;
  };
  for (std::size_t camera = 0; camera < cameras.size(); ++camera) {
    if (!is_held(camera)) state.camera_from_world[camera] = cameras[camera].camera_from_world;
  }
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (!is_held(static_cast<std::size_t>(observations[i].camera))) is_used[i] = false;
  }
  return is_used;
}

void check(const BundleProblem& problem) {
  const auto is_position = [](int i, std::size_t size) {
    return i >= 0 && static_cast<std::size_t>(i) < size;
  };
  core::require(std::any_of(problem.cameras.begin(), problem.cameras.end(),
                            [](const BundleCamera& camera) { return camera.is_fixed; }),
                "a bundle adjustment has a fixed camera");
  for (const auto& o : problem.observations) {
    core::require(is_position(o.camera, problem.cameras.size()) &&
                      is_position(o.point, problem.points_in_world.size()),
                  "an observation joins a camera and a point of the problem");
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
  BundleState state{&problem, {}, problem.points_in_world, {}};
  for (const auto& camera : problem.cameras)
    state.camera_from_world.push_back(camera.camera_from_world);
  const auto num_free = std::count_if(problem.cameras.begin(), problem.cameras.end(),
                                      [](const BundleCamera& camera) { return !camera.is_fixed; });
  const auto minimise = num_free <= kMaxDenseCameras ? minimise_by_schur : minimise_by_ceres;

  BundleResult result;
  state.is_used = of_supported_points(problem, visible(state));
  result.num_iterations += minimise(state, true, config.bundle_iterations);
  state.is_used = of_supported_points(
      problem, of_held_cameras(state, of_supported_points(problem, inliers(state)),
                               config.bundle_min_observations));
  result.num_iterations += minimise(state, false, config.bundle_iterations);
  result.is_inlier = inliers(state);
  result.camera_from_world = std::move(state.camera_from_world);
  result.points_in_world = std::move(state.points_in_world);
  return result;
}

}  // namespace samewhere::optimize
