#include <gtest/gtest.h>

#include <samewhere/optimize/schur.hpp>
#include <samewhere/optimize/test_scene.hpp>

namespace samewhere::optimize {
namespace {

BundleState state_of(const BundleProblem& problem) {
  BundleState state{&problem, {}, problem.points_in_world, {}};
  for (const auto& camera : problem.cameras)
    state.camera_from_world.push_back(camera.camera_from_world);
  state.is_used.assign(problem.observations.size(), true);
  return state;
}

double cost_of(const BundleState& state, bool is_robust) {
  double sum = 0.0;
  for (std::size_t i = 0; i < state.is_used.size(); ++i) {
    if (!state.is_used[i]) continue;
    const BundleObservation& o = state.problem->observations[i];
    const auto camera = static_cast<std::size_t>(o.camera);
    const Reprojection r =
        bundle_residual(state.problem->cameras[camera], state.camera_from_world[camera],
                        state.points_in_world[static_cast<std::size_t>(o.point)], o.seen)
            .reprojection;
    const double square = r.value.squaredNorm();
    const double threshold = kChiSquare95[r.size];
    sum +=
        is_robust && square > threshold ? 2.0 * std::sqrt(threshold * square) - threshold : square;
  }
  return 0.5 * sum;
}

void spoil_some_observations(BundleProblem& problem, core::Random& random) {
  for (auto& o : problem.observations) {
    if (random.uniform() < 0.05) o.seen.undistorted_px.x() += random.uniform(10.0, 40.0);
  }
}

// Depth or not, with a robust loss or not.
class BothSolvers : public testing::TestWithParam<std::tuple<bool, bool>> {};

TEST_P(BothSolvers, FindTheSameMinimum) {
  const auto [has_depth, is_robust] = GetParam();
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    core::Random random(seed);
    BundleProblem problem =
        disturbed(test_scene({.num_fixed = 2, .has_depth = has_depth}, random), 0.01, 0.03, random);
    if (is_robust) spoil_some_observations(problem, random);
    BundleState ours = state_of(problem);
    BundleState theirs = ours;
    const double before = cost_of(ours, is_robust);
    EXPECT_GT(minimise_by_schur(ours, is_robust, 60), 1);
    minimise_by_ceres(theirs, is_robust, 60);
    const double reached = cost_of(ours, is_robust);
    EXPECT_LT(reached, 0.5 * before) << "seed " << seed;
    EXPECT_NEAR(reached, cost_of(theirs, is_robust), 1e-3 * reached) << "seed " << seed;
    for (std::size_t i = 0; i < problem.cameras.size(); ++i) {
      const core::Rigid3 apart = inverse(ours.camera_from_world[i]) * theirs.camera_from_world[i];
      EXPECT_LT(core::log_r3so3(apart).norm(), 1e-3) << "seed " << seed << ", camera " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(DepthAndLoss, BothSolvers,
                         testing::Combine(testing::Bool(), testing::Bool()));

TEST(Schur, NeverIncreasesTheCost) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    core::Random random(seed);
    const BundleProblem problem =
        disturbed(test_scene({.num_points = 60, .has_depth = false}, random), 0.1, 0.4, random);
    BundleState state = state_of(problem);
    for (std::size_t i = 0; i < state.is_used.size(); ++i) {
      const BundleObservation& o = problem.observations[i];
      const auto& pose = problem.cameras[static_cast<std::size_t>(o.camera)].camera_from_world;
      const auto point = static_cast<std::size_t>(o.point);
      state.is_used[i] = (pose * problem.points_in_world[point]).z() > 0.1;
    }
    const double before = cost_of(state, false);
    for (int i = 0; i < 5; ++i) {
      minimise_by_schur(state, false, 1);
      const double now = cost_of(state, false);
      EXPECT_LE(now, before * (1.0 + 1e-12)) << "seed " << seed << ", iteration " << i;
    }
  }
}

TEST(Schur, WithoutObservationsEverythingStays) {
  core::Random random(3);
  const BundleProblem problem = test_scene({}, random);
  BundleState state = state_of(problem);
  state.is_used.assign(state.is_used.size(), false);
  EXPECT_EQ(minimise_by_schur(state, true, 10), 0);
  EXPECT_EQ(state.points_in_world, problem.points_in_world);
}

TEST(Schur, APointBehindACameraDoesNotStopEitherSolver) {
  core::Random random(4);
  BundleProblem problem = disturbed(test_scene({}, random), 0.02, 0.05, random);
  const auto seen = static_cast<std::size_t>(problem.observations.front().point);
  problem.points_in_world[seen].z() = -3.0;
  for (const auto minimise : {minimise_by_schur, minimise_by_ceres}) {
    BundleState state = state_of(problem);
    EXPECT_GT(minimise(state, true, 10), 1);
    for (int i = 0; i < 6; ++i) {
      const core::Rigid3& found = state.camera_from_world[static_cast<std::size_t>(i)];
      EXPECT_LT(core::log_r3so3(inverse(camera_on_walk(i)) * found).norm(), 0.01);
    }
    EXPECT_EQ(state.points_in_world[seen].z(), -3.0) << "nothing tells where to move it";
  }
}

}  // namespace
}  // namespace samewhere::optimize
