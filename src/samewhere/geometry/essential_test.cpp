#include <algorithm>

#include <gtest/gtest.h>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/geometry/essential.hpp>
#include <samewhere/geometry/test_pairs.hpp>

namespace samewhere::geometry {
namespace {

double best_error_rad(const Eigen::Matrix3d& essential, const core::Rigid3& truth) {
  double best = 1e9;
  for (const auto& motion : motions_of_essential(essential)) {
    best = std::min(best, motion_error_rad(motion, truth));
  }
  return best;
}

void expect_true_motion_among_solutions(const TestScene& scene, core::Random& random,
                                        std::uint64_t seed) {
  double best = 1e9;
  for (const auto& essential : solve_essential_5(test_pairs(scene, random))) {
    best = std::min(best, best_error_rad(essential, scene.second_from_first));
  }
  EXPECT_LT(best, 1e-4) << "seed " << seed;
}

TEST(Essential, FiveExactPairsOfAnySceneGiveTheMotion) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    core::Random random(seed);
    expect_true_motion_among_solutions(
        {.second_from_first = random_motion(random), .num_points = 5, .depth_m = general_depth},
        random, seed);
  }
}

TEST(Essential, FivePairsOfAWallGiveTheMotionToo) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    core::Random random(seed);
    expect_true_motion_among_solutions({.second_from_first = random_motion(random),
                                        .num_points = 5,
                                        .depth_m = plane_depth({0.1, -0.05, 0.3})},
                                       random, seed);
  }
}

TEST(Essential, SolutionsAreEssentialMatrices) {
  core::Random random(7);
  const RayPairs pairs = test_pairs(
      {.second_from_first = random_motion(random), .num_points = 5, .depth_m = general_depth},
      random);
  const auto solutions = solve_essential_5(pairs);
  EXPECT_FALSE(solutions.empty());
  for (const auto& e : solutions) {
    EXPECT_LT(std::abs(e.determinant()), 1e-9);
    const Eigen::Matrix3d square = e * e.transpose();
    EXPECT_LT((2.0 * square * e - square.trace() * e).norm(), 1e-8);
  }
}

// Two cameras of unlike focal lengths and centres; F is that of its definition, K2^-T E K1^-1.
TEST(Essential, OfAFundamentalMatrixGivesTheMotion) {
  const core::Camera first = core::PinholeRadtan{640, 480, 500, 510, 320, 240};
  const core::Camera second = core::PinholeRadtan{752, 480, 430, 425, 370, 250};
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    core::Random random(seed);
    const core::Rigid3 truth = random_motion(random);
    const Eigen::Matrix3d fundamental = calibration_matrix(second).inverse().transpose() *
                                        essential_of(truth) * calibration_matrix(first).inverse();
    const Eigen::Matrix3d essential = essential_from_fundamental(3.0 * fundamental, first, second);
    EXPECT_LT(best_error_rad(essential, truth), 1e-6) << "seed " << seed;
  }
}

TEST(Essential, IsFoundAmongOutliersAndRefined) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    core::Random random(seed);
    core::Rigid3 half_a_metre = random_motion(random);
    half_a_metre.translation *= 0.5 / half_a_metre.translation.norm();
    const TestScene scene{.second_from_first = half_a_metre,
                          .num_points = 300,
                          .noise_px = 0.5,
                          .outlier_ratio = 0.3,
                          .depth_m = general_depth};
    const RayPairs pairs = test_pairs(scene, random);
    const auto found =
        estimate_essential(pairs, {.max_error_px = 2.0, .max_iterations = 300}, random);
    ASSERT_TRUE(found) << "seed " << seed;
    EXPECT_GT(found->inliers.size(), 180U) << "seed " << seed;
    double best = 1e9;
    for (const auto& motion : motions_of_essential(found->model)) {
      const core::Rigid3 refined = refine_motion(subset(pairs, found->inliers), motion);
      best = std::min(best, motion_error_rad(refined, scene.second_from_first));
    }
    EXPECT_LT(best, 0.05) << "seed " << seed;
  }
}

TEST(Essential, RefinementOfExactPairsFindsTheMotion) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    core::Random random(seed);
    const core::Rigid3 truth = random_motion(random);
    const RayPairs pairs = test_pairs(
        {.second_from_first = truth, .num_points = 60, .depth_m = general_depth}, random);
    const core::Rigid3 disturbed{
        core::exp_so3({0.01, -0.01, 0.01}) * truth.rotation,
        truth.translation.normalized() + Eigen::Vector3d(0.05, -0.05, 0.05)};
    const core::Rigid3 refined = refine_motion(pairs, disturbed);
    EXPECT_LT(motion_error_rad(refined, truth), 1e-5) << "seed " << seed;
    EXPECT_NEAR(refined.translation.norm(), 1.0, 1e-12);
  }
}

TEST(Essential, EpipolarErrorIsTheDistanceFromTheLine) {
  core::Random random(3);
  const core::Rigid3 sideways{Eigen::Quaterniond::Identity(), {-0.5, 0.0, 0.0}};
  RayPairs pairs = test_pairs(
      {.second_from_first = sideways, .num_points = 10, .depth_m = general_depth}, random);
  for (auto& ray : pairs.second) {
    ray = (ray / ray.z() + Eigen::Vector3d(0.0, 3.0 / kTestFocal_px, 0.0)).normalized();
  }
  for (int i = 0; i < pairs.size(); ++i) {
    const TransferError error = epipolar_error(essential_of(sideways), pairs, i);
    EXPECT_NEAR(error.in_first, 9.0, 1e-9) << "epipolar lines are rows";
    EXPECT_NEAR(error.in_second, 9.0, 1e-9);
  }
}

}  // namespace
}  // namespace samewhere::geometry
