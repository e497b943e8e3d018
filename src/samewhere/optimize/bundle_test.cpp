#include <algorithm>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/optimize/bundle.hpp>
#include <samewhere/optimize/manifold.hpp>
#include <samewhere/optimize/test_scene.hpp>

namespace samewhere::optimize {
namespace {

double worst_pose_error(const BundleProblem& truth, const BundleResult& result) {
  double worst = 0.0;
  for (std::size_t i = 0; i < truth.cameras.size(); ++i) {
    const core::Rigid3 error =
        inverse(truth.cameras[i].camera_from_world) * result.camera_from_world[i];
    worst = std::max(worst, core::log_r3so3(error).norm());
  }
  return worst;
}

TEST(Bundle, AnalyticJacobiansEqualNumericOnes) {
  constexpr double kStep = 1e-6;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    core::Random random(seed);
    const BundleProblem scene = test_scene({.has_depth = seed % 2 == 0}, random);
    const BundleObservation& o = scene.observations[random.index(scene.observations.size())];
    const BundleCamera& camera = scene.cameras[static_cast<std::size_t>(o.camera)];
    const core::Rigid3& pose = camera.camera_from_world;
    const Eigen::Vector3d& point = scene.points_in_world[static_cast<std::size_t>(o.point)];
    const auto value = [&](const core::Rigid3& p, const Eigen::Vector3d& x) {
      return bundle_residual(camera, p, x, o.seen).reprojection.value;
    };
    const BundleResidual analytic = bundle_residual(camera, pose, point, o.seen);
    EXPECT_EQ(analytic.reprojection.size, seed % 2 == 0 ? 3 : 2);
    for (int i = 0; i < 6; ++i) {
      const core::Vector6d d = kStep * core::Vector6d::Unit(i);
      const Eigen::Vector3d numeric =
          (value(retract(pose, d), point) - value(retract(pose, -d), point)) / (2 * kStep);
      EXPECT_LT((analytic.by_pose.col(i) - numeric).norm(), 1e-4 * (1.0 + numeric.norm()))
          << "seed " << seed;
    }
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d numeric =
          (value(pose, point + d) - value(pose, point - d)) / (2 * kStep);
      EXPECT_LT((analytic.by_point.col(i) - numeric).norm(), 1e-4 * (1.0 + numeric.norm()))
          << "seed " << seed;
    }
  }
}

TEST(Bundle, ACameraWithFewInliersKeepsItsPose) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    core::Random random(seed);
    const BundleProblem truth = test_scene({}, random);
    BundleProblem scene = disturbed(truth, 0.02, 0.05, random);
    constexpr int kLost = 4;
    int num_seen = 0;
    for (auto& o : scene.observations) {  // all but five show something else
      if (o.camera == kLost && num_seen++ >= 5)
        o.seen.undistorted_px = {random.uniform(0, 640), random.uniform(0, 480)};
    }
    const BundleResult result = solve_bundle(scene, {});
    EXPECT_EQ(result.camera_from_world[kLost].matrix(),
              scene.cameras[kLost].camera_from_world.matrix())
        << "seed " << seed;
    const core::Rigid3 neighbour =
        inverse(truth.cameras[3].camera_from_world) * result.camera_from_world[3];
    EXPECT_LT(core::log_r3so3(neighbour).norm(), 0.02) << "seed " << seed;
  }
}

TEST(Bundle, RecoversADisturbedSceneWithDepthAndOneFixedCamera) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    core::Random random(seed);
    const BundleProblem truth = test_scene({}, random);
    const BundleResult result = solve_bundle(disturbed(truth, 0.02, 0.05, random), {});
    EXPECT_LT(worst_pose_error(truth, result), 0.006) << "seed " << seed;
    EXPECT_EQ(result.camera_from_world[0].matrix(), truth.cameras[0].camera_from_world.matrix())
        << "fixed";
  }
}

TEST(Bundle, RecoversADisturbedSceneWithoutDepthAndTwoFixedCameras) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    core::Random random(seed);
    const BundleProblem truth = test_scene({.num_fixed = 2, .has_depth = false}, random);
    const BundleResult result =
        solve_bundle(disturbed(truth, 0.01, 0.03, random), {.bundle_iterations = 20});
    EXPECT_LT(worst_pose_error(truth, result), 0.02) << "seed " << seed;
  }
}

TEST(Bundle, IsExactWithoutNoise) {
  core::Random random(3);
  const BundleProblem truth = test_scene({.noise_px = 0.0}, random);
  const BundleResult result =
      solve_bundle(disturbed(truth, 0.02, 0.05, random), {.bundle_iterations = 30});
  EXPECT_LT(worst_pose_error(truth, result), 1e-4);
  for (std::size_t i = 0; i < truth.points_in_world.size(); ++i) {
    if (std::none_of(truth.observations.begin(), truth.observations.end(),
                     [&](const auto& o) { return o.point == static_cast<int>(i); })) {
      continue;
    }
    EXPECT_LT((result.points_in_world[i] - truth.points_in_world[i]).norm(), 1e-3) << "point " << i;
  }
}

TEST(Bundle, RejectsFalseMatches) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    core::Random random(seed);
    const BundleProblem truth = test_scene({}, random);
    BundleProblem start = disturbed(truth, 0.01, 0.02, random);
    std::vector<bool> is_wrong;
    for (auto& o : start.observations) {
      is_wrong.push_back(random.uniform() < 0.1);
      if (is_wrong.back()) o.seen.undistorted_px += Eigen::Vector2d(random.uniform(15, 60), 20.0);
    }
    const BundleResult result = solve_bundle(start, {});
    EXPECT_LT(worst_pose_error(truth, result), 0.01) << "seed " << seed;
    int num_mistaken = 0;
    for (std::size_t i = 0; i < is_wrong.size(); ++i)
      num_mistaken += is_wrong[i] == result.is_inlier[i] ? 1 : 0;
    EXPECT_LT(num_mistaken, 0.05 * static_cast<double>(is_wrong.size())) << "seed " << seed;
  }
}

TEST(Bundle, SolvesToTheSameBitsTwice) {
  core::Random random(4);
  const BundleProblem start = disturbed(test_scene({}, random), 0.02, 0.05, random);
  const BundleResult first = solve_bundle(start, {});
  const BundleProblem copy = start;
  const BundleResult second = solve_bundle(copy, {});
  for (std::size_t i = 0; i < first.camera_from_world.size(); ++i) {
    EXPECT_EQ(first.camera_from_world[i].matrix(), second.camera_from_world[i].matrix());
  }
}

TEST(Bundle, APointObservedOnceWithoutDepthStaysAndConstrainsNoCamera) {
  core::Random random(5);
  BundleProblem scene = test_scene({.num_fixed = 2, .noise_px = 0.0, .has_depth = false}, random);
  // a point in a wrong place that only camera 5 sees: it must not pull the camera
  scene.points_in_world.emplace_back(0.5, 0.0, 3.0);
  BundleObservation once{5, static_cast<int>(scene.points_in_world.size()) - 1, {}};
  once.seen.undistorted_px = {300.0, 200.0};
  once.seen.right_x_px = std::numeric_limits<double>::quiet_NaN();
  scene.observations.push_back(once);
  const BundleResult result = solve_bundle(scene, {});
  EXPECT_EQ(result.points_in_world.back(), scene.points_in_world.back());
  EXPECT_LT(worst_pose_error(scene, result), 1e-6);
}

TEST(Bundle, WithoutAFreeCameraOnlyThePointsMove) {
  core::Random random(6);
  const BundleProblem truth = test_scene({.num_fixed = 6, .noise_px = 0.0}, random);
  const BundleResult result = solve_bundle(disturbed(truth, 0.0, 0.05, random), {});
  EXPECT_EQ(worst_pose_error(truth, result), 0.0);
  const auto& o = truth.observations.front();
  const auto seen = static_cast<std::size_t>(o.point);
  EXPECT_LT((result.points_in_world[seen] - truth.points_in_world[seen]).norm(), 1e-3);
}

TEST(Bundle, RefusesProblemsWithoutFixedCameraAndObservationsOfMissingPoints) {
  core::Random random(7);
  EXPECT_THROW(solve_bundle(test_scene({.num_fixed = 0}, random), {}), core::ContractError);
  BundleProblem scene = test_scene({}, random);
  scene.observations.push_back({99, 0, {}});
  EXPECT_THROW(solve_bundle(scene, {}), core::ContractError);
}

TEST(Bundle, WithoutObservationsEverythingStays) {
  core::Random random(8);
  BundleProblem scene = test_scene({}, random);
  scene.observations.clear();
  const BundleResult result = solve_bundle(scene, {});
  EXPECT_EQ(result.num_iterations, 0);
  EXPECT_EQ(result.points_in_world, scene.points_in_world);
}

}  // namespace
}  // namespace samewhere::optimize
