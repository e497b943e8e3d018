#include <gtest/gtest.h>

#include <samewhere/geometry/pnp.hpp>
#include <samewhere/geometry/polynomial.hpp>

namespace samewhere::geometry {
namespace {

core::Rigid3 random_pose(core::Random& random) {
  const Eigen::Vector3d axis(random.gaussian(), random.gaussian(), random.gaussian());
  return {core::exp_so3(axis), {random.gaussian(), random.gaussian(), random.gaussian()}};
}

// Points in front of a camera, seen with some pixels of noise; a share of the bearings is nonsense.
PnpProblem random_problem(const core::Rigid3& camera_from_world, core::Random& random,
                          double noise_px, double outlier_ratio) {
  PnpProblem problem;
  problem.focal_px = 500.0;
  for (int i = 0; i < 200; ++i) {
    const double depth_m = random.uniform(1.0, 6.0);
    const Eigen::Vector3d in_camera(random.uniform(-0.6, 0.6) * depth_m,
                                    random.uniform(-0.5, 0.5) * depth_m, depth_m);
    Eigen::Vector3d direction = in_camera / depth_m;
    direction.x() += noise_px / problem.focal_px * random.gaussian();
    direction.y() += noise_px / problem.focal_px * random.gaussian();
    if (random.uniform() < outlier_ratio) {
      direction = {random.uniform(-0.6, 0.6), random.uniform(-0.5, 0.5), 1.0};
    }
    problem.points_in_world.push_back(inverse(camera_from_world) * in_camera);
    problem.bearings.push_back(direction.normalized());
  }
  return problem;
}

double error_of(const core::Rigid3& found, const core::Rigid3& truth) {
  return core::log_r3so3(inverse(found) * truth).norm();
}

TEST(P3p, OneOfItsAnswersIsTheTruth) {
  int num_found = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    core::Random random(seed);
    const core::Rigid3 truth = random_pose(random);
    const PnpProblem problem = random_problem(truth, random, 0.0, 0.0);
    const auto& p = problem.points_in_world;
    const auto& f = problem.bearings;
    double best = 1e9;
    for (const auto& pose : solve_p3p({p[0], p[1], p[2]}, {f[0], f[1], f[2]})) {
      best = std::min(best, error_of(pose, truth));
    }
    if (best < 1e-5) ++num_found;
  }
  EXPECT_GE(num_found, 497) << "of 500; near-degenerate triangles may fail";
}

TEST(P3p, PointsOnALineGiveNoPose) {
  const Eigen::Vector3d z(0.0, 0.0, 1.0);
  EXPECT_TRUE(
      solve_p3p({Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(1, 0, 2), Eigen::Vector3d(2, 0, 2)},
                {z, z, z})
          .empty());
}

TEST(Pnp, FindsThePoseAmongSixtyPercentOutliers) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    core::Random random(seed);
    const core::Rigid3 truth = random_pose(random);
    const PnpProblem problem = random_problem(truth, random, 0.5, 0.6);
    const auto result = estimate_pose(problem, {.max_error_px = 3.0, .min_inliers = 30}, random);
    ASSERT_TRUE(result) << "seed " << seed;
    EXPECT_LT(error_of(result->model, truth), 0.1) << "seed " << seed;
    EXPECT_GT(result->inliers.size(), 50U) << "seed " << seed;
  }
}

TEST(Pnp, NonsenseHasNoPose) {
  core::Random random(3);
  const PnpProblem problem = random_problem(core::Rigid3{}, random, 0.0, 1.0);
  EXPECT_FALSE(estimate_pose(problem, {.max_error_px = 2.0, .min_inliers = 20}, random));
  EXPECT_FALSE(estimate_pose(PnpProblem{}, {}, random));
}

TEST(Pnp, TheSameSeedGivesTheSameBits) {
  core::Random make(5);
  const PnpProblem problem = random_problem(random_pose(make), make, 1.0, 0.5);
  core::Random first(11);
  core::Random second(11);
  const auto a = estimate_pose(problem, {}, first);
  const auto b = estimate_pose(problem, {}, second);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->model.matrix(), b->model.matrix());
  EXPECT_EQ(a->inliers, b->inliers);
}

TEST(Polynomial, FindsTheRootsItWasMadeFrom) {
  core::Random random(1);
  for (int i = 0; i < 200; ++i) {
    const double r[4] = {random.uniform(-3, -2), random.uniform(-1, 0), random.uniform(1, 2),
                         random.uniform(3, 4)};
    std::vector<double> c = {1.0};
    for (const double root : r) {
      c.insert(c.begin(), 0.0);                                                // times x ...
      for (std::size_t k = 0; k + 1 < c.size(); ++k) c[k] -= root * c[k + 1];  // ... minus the root
    }
    const std::vector<double> found = real_roots(c);
    ASSERT_EQ(found.size(), 4U);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(found[k], r[k], 1e-9);
  }
}

TEST(Polynomial, DegenerateDegreesAreDecided) {
  EXPECT_TRUE(real_roots(std::vector<double>{}).empty());
  EXPECT_TRUE(real_roots(std::vector<double>{0.0, 0.0}).empty());
  EXPECT_TRUE(real_roots(std::vector<double>{4.0}).empty());
  EXPECT_TRUE(real_roots(std::vector<double>{1.0, 0.0, 1.0}).empty());  // x^2 + 1
  EXPECT_EQ(real_roots(std::vector<double>{-6.0, 2.0, 0.0}), std::vector<double>{3.0});
}

}  // namespace
}  // namespace samewhere::geometry
