#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/optimize/manifold.hpp>
#include <samewhere/optimize/motion_only.hpp>
#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {
namespace {

core::Vector6d random_vector(core::Random& random, double size) {
  core::Vector6d v;
  for (int i = 0; i < 6; ++i) v(i) = size * random.gaussian();
  return v;
}

core::Rigid3 random_pose(core::Random& random) {
  return core::exp_r3so3(random_vector(random, 0.8));
}

core::Matrix6d random_information(core::Random& random) {
  core::Matrix6d root;
  for (int i = 0; i < 6; ++i) root.col(i) = random_vector(random, 3.0);
  return root * root.transpose() + core::Matrix6d::Identity();
}

// Central differences of f(retract(pose, d)) by d.
template <int Rows, class Function>
Eigen::Matrix<double, Rows, 6> numeric_jacobian(const core::Rigid3& pose, const Function& f) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix<double, Rows, 6> jacobian;
  for (int i = 0; i < 6; ++i) {
    const core::Vector6d step = kStep * core::Vector6d::Unit(i);
    jacobian.col(i) = (f(retract(pose, step)) - f(retract(pose, -step))) / (2.0 * kStep);
  }
  return jacobian;
}

TEST(Whitening, SquaredNormIsTheInformationsQuadraticForm) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    core::Random random(seed);
    const core::Matrix6d information = random_information(random);
    const core::Vector6d r = random_vector(random, 1.0);
    const double expected = r.dot(information * r);
    EXPECT_NEAR((whitening(information) * r).squaredNorm(), expected, 1e-9 * expected)
        << "seed " << seed;
  }
  EXPECT_THROW(whitening(core::Matrix6d::Zero()), core::ContractError);
}

TEST(Manifold, RightJacobianInverseIsTheDerivativeOfTheLogarithm) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    core::Random random(seed);
    const Eigen::Vector3d r = (seed < 5 ? 1e-6 : 0.7) * random_vector(random, 1.0).head<3>();
    const Eigen::Matrix3d analytic = right_jacobian_inverse(r);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d d = 1e-6 * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d difference = core::log_so3(core::exp_so3(r) * core::exp_so3(d)) -
                                         core::log_so3(core::exp_so3(r) * core::exp_so3(-d));
      EXPECT_LT((difference / 2e-6 - analytic.col(i)).norm(), 1e-6) << "seed " << seed;
    }
  }
}

TEST(PoseGraph, AnalyticJacobiansEqualNumericOnes) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    core::Random random(seed);
    const PoseEdge edge{0, 1, random_pose(random)};
    const core::Rigid3 a = random_pose(random);
    const core::Rigid3 b = a * edge.a_from_b * core::exp_r3so3(random_vector(random, 0.2));
    const EdgeJacobians analytic = edge_jacobians(edge, a, b);
    const auto by_a =
        numeric_jacobian<6>(a, [&](const auto& moved) { return edge_error(edge, moved, b); });
    const auto by_b =
        numeric_jacobian<6>(b, [&](const auto& moved) { return edge_error(edge, a, moved); });
    EXPECT_LT((analytic.by_a - by_a).norm(), 1e-6) << "seed " << seed;
    EXPECT_LT((analytic.by_b - by_b).norm(), 1e-6) << "seed " << seed;
  }
}

// A walk around a square: exact edges, drifted start values, one loop edge.
PoseGraph square_walk(core::Random& random, std::vector<core::Rigid3>& truth) {
  PoseGraph graph;
  truth = {core::Rigid3{}};
  graph.world_from_node = truth;
  for (int i = 1; i < 40; ++i) {
    const double turn_rad = i % 10 == 0 ? 1.5708 : 0.0;
    const core::Rigid3 step{core::exp_so3({0.0, turn_rad, 0.0}), {0.0, 0.0, 1.0}};
    truth.push_back(truth.back() * step);
    graph.edges.push_back({i - 1, i, step, random_information(random)});
    graph.world_from_node.push_back(graph.world_from_node.back() * step *
                                    core::exp_r3so3(random_vector(random, 0.01)));
  }
  graph.edges.push_back({0, 39, inverse(truth[0]) * truth[39], random_information(random), true});
  return graph;
}

TEST(PoseGraph, ExactEdgesCorrectDrift) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    core::Random random(seed);
    std::vector<core::Rigid3> truth;
    PoseGraph graph = square_walk(random, truth);
    const PoseGraphSummary summary = solve_pose_graph(graph, {});
    EXPECT_LT(summary.final_cost, 1e-9) << "seed " << seed;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      EXPECT_LT(core::log_r3so3(inverse(truth[i]) * graph.world_from_node[i]).norm(), 1e-5)
          << "seed " << seed;
    }
  }
}

TEST(PoseGraph, SolvesToTheSameBitsTwice) {
  core::Random random(3);
  std::vector<core::Rigid3> truth;
  PoseGraph first = square_walk(random, truth);
  PoseGraph second = first;
  solve_pose_graph(first, {});
  solve_pose_graph(second, {});
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_EQ(first.world_from_node[i].matrix(), second.world_from_node[i].matrix());
  }
}

TEST(PoseGraph, RefusesAnEdgeToAMissingNode) {
  PoseGraph graph{{core::Rigid3{}, core::Rigid3{}}, {PoseEdge{.a = 0, .b = 2}}};
  EXPECT_THROW(solve_pose_graph(graph, {}), core::ContractError);
}

MotionProblem random_motion(core::Random& random, const core::Rigid3& camera_from_world,
                            double noise_px, double outlier_ratio) {
  MotionProblem problem{{640, 480, 500, 505, 320, 240}, 0.075, {}};
  for (int i = 0; i < 200; ++i) {
    const double z = random.uniform(1.0, 6.0);
    const Eigen::Vector3d p(random.uniform(-0.6, 0.6) * z, random.uniform(-0.4, 0.4) * z, z);
    const double x = 500 * p.x() / z + 320 + noise_px * random.gaussian();
    const double y = 505 * p.y() / z + 240 + noise_px * random.gaussian();
    MotionObservation seen{inverse(camera_from_world) * p, {x, y}};
    if (i % 2 == 0) seen.right_x_px = x - 500 * 0.075 / z;
    if (random.uniform() < outlier_ratio)
      seen.undistorted_px = {random.uniform(0, 640), random.uniform(0, 480)};
    problem.observations.push_back(seen);
  }
  return problem;
}

TEST(MotionOnly, AnalyticJacobianEqualsTheNumericOne) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    core::Random random(seed);
    const core::Rigid3 pose = random_pose(random);
    const MotionProblem problem = random_motion(random, pose, 1.0, 0.0);
    for (int i = 0; i < 4; ++i) {
      const auto& seen = problem.observations[static_cast<std::size_t>(i)];
      const auto numeric = numeric_jacobian<3>(pose, [&](const auto& moved) {
        return Eigen::Vector3d(motion_residual(problem, seen, moved).value);
      });
      const MotionResidual analytic = motion_residual(problem, seen, pose);
      EXPECT_EQ(analytic.size, i % 2 == 0 ? 3 : 2);
      EXPECT_LT((analytic.jacobian - numeric).norm(), 1e-4 * (1.0 + numeric.norm()))
          << "seed " << seed;
    }
  }
}

TEST(MotionOnly, EstimatesThePoseDespiteOutliers) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    core::Random random(seed);
    const core::Rigid3 truth = random_pose(random);
    const MotionProblem problem = random_motion(random, truth, 0.5, 0.2);
    const MotionResult result =
        refine_pose(problem, retract(truth, random_vector(random, 0.02)), {});
    EXPECT_LT(core::log_r3so3(inverse(truth) * result.camera_from_world).norm(), 0.01)
        << "seed " << seed;
    EXPECT_GT(result.num_inliers, 140) << "seed " << seed;
    EXPECT_LT(result.num_inliers, 180) << "seed " << seed;
    EXPECT_NEAR(result.reprojection_rmse_px, 0.7, 0.25) << "seed " << seed;
  }
}

// Mean of error' covariance^-1 error over many pictures, each with errors of its own and with such
// as the 24 parts of a picture have in common.
double mean_normalised_square(double own_px, double shared_px) {
  constexpr int kNumPictures = 200;
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < kNumPictures; ++seed) {
    core::Random random(seed);
    const core::Rigid3 truth = random_pose(random);
    MotionProblem problem = random_motion(random, truth, own_px, 0.0);
    std::array<Eigen::Vector2d, 24> shared;
    for (auto& error : shared)
      error = shared_px * Eigen::Vector2d(random.gaussian(), random.gaussian());
    for (auto& seen : problem.observations) {
      const auto column = std::clamp(static_cast<int>(seen.undistorted_px.x() / 107.0), 0, 5);
      const auto row = std::clamp(static_cast<int>(seen.undistorted_px.y() / 120.0), 0, 3);
      const Eigen::Vector2d& error = shared[static_cast<std::size_t>(6 * row + column)];
      seen.undistorted_px += error;
      seen.right_x_px += error.x();
    }
    const MotionResult found = refine_pose(problem, truth, {});
    core::Vector6d error;
    error << found.camera_from_world.translation - truth.translation,
        core::log_so3(found.camera_from_world.rotation * truth.rotation.conjugate());
    sum += error.dot(found.covariance.ldlt().solve(error));
  }
  return sum / kNumPictures;
}

// Of six numbers. Where nothing is shared both parts of the covariance say the same, and it is
// twice as large as the errors are.
TEST(MotionOnly, CovarianceIncludesErrorsCorrelatedWithinACell) {
  EXPECT_NEAR(mean_normalised_square(0.5, 0.0), 3.0, 1.0);
  EXPECT_NEAR(mean_normalised_square(0.05, 0.0), 3.0, 1.0);
  EXPECT_LT(mean_normalised_square(0.3, 0.5), 14.0);
}

TEST(MotionOnly, WithFewInliersThePoseStays) {
  core::Random random(1);
  const core::Rigid3 start = random_pose(random);
  const MotionResult result = refine_pose({{640, 480, 500, 500, 320, 240}, 0.075, {}}, start, {});
  EXPECT_EQ(result.num_inliers, 0);
  EXPECT_EQ(result.camera_from_world.matrix(), start.matrix());
  EXPECT_EQ(result.covariance, core::Matrix6d(core::Matrix6d::Identity()));
}

}  // namespace
}  // namespace samewhere::optimize
