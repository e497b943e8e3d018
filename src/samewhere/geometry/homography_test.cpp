#include <gtest/gtest.h>

#include <samewhere/geometry/homography.hpp>
#include <samewhere/geometry/test_pairs.hpp>

namespace samewhere::geometry {
namespace {

const Eigen::Vector3d kWall(0.1, -0.05, 0.3);  // tilted, a good three metres away

double worst_error_px(const Homography& homography, const RayPairs& pairs) {
  double worst = 0.0;
  for (int i = 0; i < pairs.size(); ++i) {
    worst = std::max(worst, transfer_error(homography, pairs, i).larger());
  }
  return std::sqrt(worst);
}

TEST(Homography, FourExactPairsOfAWallGiveThoseOfAllOthers) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    core::Random random(seed);
    const TestScene scene{.second_from_first = random_motion(random),
                          .num_points = 50,
                          .depth_m = plane_depth(kWall)};
    const RayPairs all = test_pairs(scene, random);
    const auto homography = solve_homography(subset(all, {0, 1, 2, 3}));
    ASSERT_TRUE(homography) << "seed " << seed;
    EXPECT_LT(worst_error_px(*homography, all), 1e-3) << "seed " << seed;
  }
}

TEST(Homography, FewPairsOrPairsOnALineHaveNone) {
  core::Random random(1);
  const TestScene scene{
      .second_from_first = random_motion(random), .num_points = 3, .depth_m = plane_depth(kWall)};
  RayPairs pairs = test_pairs(scene, random);
  EXPECT_FALSE(solve_homography(pairs));
  RayPairs line;
  for (const double x : {-0.3, -0.1, 0.1, 0.2}) {
    line.first.push_back(Eigen::Vector3d(x, 0.0, 1.0).normalized());
    line.second.push_back(Eigen::Vector3d(x, 0.1, 1.0).normalized());
  }
  EXPECT_FALSE(solve_homography(line));
}

TEST(Homography, IsFoundAmongOutliers) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    core::Random random(seed);
    const TestScene scene{.second_from_first = random_motion(random),
                          .noise_px = 0.5,
                          .outlier_ratio = 0.3,
                          .depth_m = plane_depth(kWall)};
    const RayPairs pairs = test_pairs(scene, random);
    const auto found =
        estimate_homography(pairs, {.max_error_px = 3.0, .max_iterations = 500}, random);
    ASSERT_TRUE(found) << "seed " << seed;
    EXPECT_GT(found->inliers.size(), 115U) << "seed " << seed;
    EXPECT_LT(found->inliers.size(), 165U) << "seed " << seed;
  }
}

TEST(Homography, OneOfItsMotionsIsTheTrueOneWithTheTruePlane) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    core::Random random(seed);
    const TestScene scene{.second_from_first = random_motion(random),
                          .num_points = 20,
                          .depth_m = plane_depth(kWall)};
    const auto homography = solve_homography(test_pairs(scene, random));
    ASSERT_TRUE(homography) << "seed " << seed;
    const auto motions = motions_of(*homography);
    ASSERT_EQ(motions.size(), 4U) << "seed " << seed;
    double best = 1e9;
    for (const auto& motion : motions) {
      const core::Rigid3 in_metres{motion.second_from_first.rotation,
                                   motion.second_from_first.translation / kWall.norm()};
      best = std::min(best, core::log_r3so3(inverse(in_metres) * scene.second_from_first).norm() +
                                (motion.normal_in_first - kWall.normalized()).norm());
    }
    EXPECT_LT(best, 1e-4) << "seed " << seed;
  }
}

TEST(Homography, ThatOfARotationHasNoMotions) {
  const Eigen::Matrix3d rotation = core::exp_so3({0.1, 0.2, -0.1}).toRotationMatrix();
  EXPECT_TRUE(motions_of({rotation, rotation.transpose()}).empty());
}

}  // namespace
}  // namespace samewhere::geometry
