#include <cmath>

#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/optimize/chordal.hpp>
#include <samewhere/optimize/initial_guesses.hpp>
#include <samewhere/optimize/spanning_tree.hpp>

namespace samewhere::optimize {
namespace {

constexpr double kStep_m = 0.02;
constexpr double kTurn_rad = 0.1;

// Two laps of a circle, with odometry whose rotation error is kTurn_rad per step.
PoseGraph circle(int num_poses, bool is_planar, const std::vector<std::pair<int, int>>& loops) {
  core::Random random(3);
  PoseGraph graph;
  graph.is_planar = is_planar;
  std::vector<core::Rigid3> truth;
  for (int i = 0; i < num_poses; ++i) {
    const double angle = 4.0 * 3.14159265358979 * i / num_poses;
    truth.push_back(
        {core::exp_so3({0.0, 0.0, angle}), {20.0 * std::sin(angle), -20.0 * std::cos(angle), 0.0}});
  }
  const auto add = [&](int a, int b, bool is_loop) {
    core::Vector6d sigma;
    sigma << Eigen::Vector3d::Constant(kStep_m), Eigen::Vector3d::Constant(kTurn_rad);
    core::Vector6d error;
    for (int i = 0; i < 6; ++i) error(i) = sigma(i) * random.gaussian();
    if (is_planar) error.segment<3>(2).setZero();
    const core::Rigid3 a_from_b =
        inverse(truth[static_cast<std::size_t>(a)]) * truth[static_cast<std::size_t>(b)];
    graph.edges.push_back({a,
                           b,
                           {a_from_b.rotation * core::exp_so3(error.tail<3>()),
                            a_from_b.translation + error.head<3>()},
                           sigma.cwiseAbs2().cwiseInverse().asDiagonal(),
                           is_loop});
  };
  graph.world_from_node.resize(truth.size());
  for (int i = 1; i < num_poses; ++i) add(i - 1, i, false);
  for (const auto& [a, b] : loops) add(a, b, true);
  place_by_spanning_tree(graph);
  return graph;
}

const std::vector<std::pair<int, int>> kLoops = {{0, 100}, {10, 110}, {0, 199}};

TEST(Chordal, RecoversPosesFromExactEdges) {
  for (const bool is_planar : {false, true}) {
    const PoseGraph truth = circle(40, is_planar, {});
    PoseGraph graph = truth;
    for (std::size_t i = 1; i < 40; ++i) graph.world_from_node[i] = core::Rigid3{};
    place_by_chordal_relaxation(graph);
    for (std::size_t i = 0; i < 40; ++i)
      EXPECT_LT(
          core::log_r3so3(inverse(truth.world_from_node[i]) * graph.world_from_node[i]).norm(),
          1e-9);
  }
}

TEST(Chordal, KeepsFixedNodesAndTheGaugeOfEveryComponent) {
  PoseGraph graph = circle(6, false, {});
  std::erase_if(graph.edges, [](const PoseEdge& edge) { return edge.a == 2; });  // two components
  graph.fixed_nodes = {4};
  const PoseGraph before = graph;
  place_by_chordal_relaxation(graph);
  for (const std::size_t held : {0, 4})
    EXPECT_EQ(graph.world_from_node[held].translation, before.world_from_node[held].translation);
}

TEST(InitialGuesses, AcceptTrueLoopsDespitePoorOdometry) {
  for (const bool is_planar : {false, true}) {
    PoseGraph graph = circle(200, is_planar, kLoops);
    const BestOfGuesses found = solve_from_initial_guesses(graph, {});
    EXPECT_TRUE(found.solution.has_converged);
    EXPECT_LT(found.solution.final_cost, 30.0);
    for (const double weight : found.solution.weights) EXPECT_EQ(weight, 1.0);
  }
}

TEST(InitialGuesses, RejectAFalseLoopAlone) {
  PoseGraph graph = circle(200, true, {{0, 100}, {10, 110}, {20, 120}, {5, 105}, {0, 199}});
  PoseEdge outlier = graph.edges.back();
  outlier.a = 30;
  outlier.b = 60;
  outlier.a_from_b.translation = {100.0, 0.0, 0.0};  // longer than the odometry
  graph.edges.push_back(outlier);
  const BestOfGuesses found = solve_from_initial_guesses(graph, {});
  EXPECT_EQ(found.solution.weights.back(), 0.0);
  for (std::size_t i = 0; i + 1 < graph.edges.size(); ++i)
    EXPECT_EQ(found.solution.weights[i], 1.0) << i;
}

TEST(InitialGuesses, GiveTheSameSolutionAfterAShiftOfAllPoses) {
  PoseGraph graph = circle(60, false, {{0, 30}, {5, 35}});
  PoseGraph shifted = graph;
  const Eigen::Vector3d far(456789.0, 5123457.0, 100.0);
  for (core::Rigid3& pose : shifted.world_from_node) pose.translation += far;
  const core::Rigid3 held = shifted.world_from_node.front();
  const double cost = solve_from_initial_guesses(graph, {}).solution.final_cost;
  EXPECT_NEAR(solve_from_initial_guesses(shifted, {}).solution.final_cost, cost, 1e-6);
  EXPECT_EQ(shifted.world_from_node.front().translation, held.translation);
  EXPECT_LT(
      (shifted.world_from_node.back().translation - far - graph.world_from_node.back().translation)
          .norm(),
      1e-3);
}

TEST(InitialGuesses, ReportMissingConvergence) {
  PoseGraph graph = circle(200, true, kLoops);
  const Config one{.graph_iterations = 1, .loop_loss = LoopLoss::kLeastSquares};
  EXPECT_FALSE(solve_from_initial_guesses(graph, one).solution.has_converged);
}

}  // namespace
}  // namespace samewhere::optimize
