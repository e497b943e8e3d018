#include <cmath>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/optimize/manifold.hpp>
#include <samewhere/optimize/scaled_edge.hpp>

namespace samewhere::optimize {
namespace {

constexpr int kLap = 40;
constexpr double kSigma_m = 0.01;  // of a step of one unit
constexpr double kSigma_rad = 0.003;
constexpr double kSigmaLogScale = 0.02;

core::Vector6d random_tangent(core::Random& random, double sigma_m, double sigma_rad) {
  core::Vector6d tangent;
  for (int i = 0; i < 6; ++i) tangent(i) = (i < 3 ? sigma_m : sigma_rad) * random.gaussian();
  return tangent;
}

// Laps around a square by a camera without depth, whose unit of length grows by 2 % a step and
// jitters; each pose of a later lap has a loop to the same place of the lap before.
struct CreepingWalk {
  PoseGraph graph;
  std::vector<core::Rigid3> truth;
  std::vector<double> true_log_scales;
};

class CreepingWalkMaker {
 public:
  explicit CreepingWalkMaker(std::uint64_t seed) : random_(seed) {}

  CreepingWalk walk(int num_laps) {
    walk_.truth = {core::Rigid3{}};
    walk_.true_log_scales = {0.0};
    for (int i = 1; i < num_laps * kLap; ++i) {
      const core::Rigid3 step{core::exp_so3({0.0, i % 10 == 0 ? 1.5707963 : 0.0, 0.0}),
                              {0.0, 0.0, 1.0}};
      walk_.truth.push_back(walk_.truth.back() * step);
      walk_.true_log_scales.push_back(walk_.true_log_scales.back() + kSigmaLogScale +
                                      0.5 * kSigmaLogScale * random_.gaussian());
    }
    for (int i = 1; i < num_laps * kLap; ++i) add_edge(i - 1, i, false);
    for (int i = kLap; i < num_laps * kLap; ++i) add_edge(i - kLap, i, true);
    follow_odometry();
    return std::move(walk_);
  }

 private:
  void add_edge(int a, int b, bool is_loop) {
    const auto i = static_cast<std::size_t>(a);
    const auto j = static_cast<std::size_t>(b);
    core::Rigid3 a_from_b = inverse(walk_.truth[i]) * walk_.truth[j];
    a_from_b.translation *= std::exp(-walk_.true_log_scales[i]);
    a_from_b = a_from_b * core::exp_r3so3(random_tangent(random_, kSigma_m, kSigma_rad));
    core::Vector6d sigma;
    sigma << Eigen::Vector3d::Constant(kSigma_m), Eigen::Vector3d::Constant(kSigma_rad);
    PoseEdge edge{a, b, a_from_b, sigma.cwiseAbs2().cwiseInverse().asDiagonal(), is_loop};
    // odometry does not observe scale drift; a loop does
    edge.log_scale = is_loop ? walk_.true_log_scales[j] - walk_.true_log_scales[i] +
                                   kSigmaLogScale * random_.gaussian()
                             : 0.0;
    edge.scale_information = 1.0 / std::pow((is_loop ? 1.0 : 1.5) * kSigmaLogScale, 2);
    walk_.graph.edges.push_back(edge);
  }

  void follow_odometry() {
    walk_.graph.world_from_node = {core::Rigid3{}};
    for (const auto& edge : walk_.graph.edges)
      if (!edge.is_loop)
        walk_.graph.world_from_node.push_back(walk_.graph.world_from_node.back() * edge.a_from_b);
    walk_.graph.log_scales.assign(walk_.truth.size(), 0.0);
  }

  core::Random random_;
  CreepingWalk walk_;
};

double ate_m(const CreepingWalk& walk) {
  double sum = 0.0;
  for (std::size_t i = 0; i < walk.truth.size(); ++i)
    sum += (walk.graph.world_from_node[i].translation - walk.truth[i].translation).squaredNorm();
  return std::sqrt(sum / static_cast<double>(walk.truth.size()));
}

TEST(ScaledEdge, AnalyticJacobiansEqualNumericOnes) {
  core::Random random(1);
  PoseEdge edge{0, 1, core::exp_r3so3(random_tangent(random, 1.0, 0.5))};
  edge.log_scale = 0.2;
  const ScaledNode a{core::exp_r3so3(random_tangent(random, 1.0, 0.5)), 0.3};
  const ScaledNode b{core::exp_r3so3(random_tangent(random, 1.0, 0.5)), -0.4};
  const ScaledEdgeJacobians analytic = scaled_edge_jacobians(edge, a, b);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    core::Vector6d step = core::Vector6d::Zero();
    step(i) = kStep;
    const Vector7d by_a =
        (scaled_edge_error(edge, {retract(a.world_from_node, step), a.log_scale}, b) -
         scaled_edge_error(edge, {retract(a.world_from_node, -step), a.log_scale}, b)) /
        (2 * kStep);
    const Vector7d by_b =
        (scaled_edge_error(edge, a, {retract(b.world_from_node, step), b.log_scale}) -
         scaled_edge_error(edge, a, {retract(b.world_from_node, -step), b.log_scale})) /
        (2 * kStep);
    EXPECT_LT((by_a - analytic.by_a.col(i)).norm(), 1e-7) << i;
    EXPECT_LT((by_b - analytic.by_b.col(i)).norm(), 1e-7) << i;
  }
  const Vector7d by_scale_of_a =
      (scaled_edge_error(edge, {a.world_from_node, a.log_scale + kStep}, b) -
       scaled_edge_error(edge, {a.world_from_node, a.log_scale - kStep}, b)) /
      (2 * kStep);
  const Vector7d by_scale_of_b =
      (scaled_edge_error(edge, a, {b.world_from_node, b.log_scale + kStep}) -
       scaled_edge_error(edge, a, {b.world_from_node, b.log_scale - kStep})) /
      (2 * kStep);
  EXPECT_LT((by_scale_of_a - analytic.by_scale_of_a).norm(), 1e-7);
  EXPECT_LT((by_scale_of_b - analytic.by_scale_of_b).norm(), 1e-7);
}

TEST(ScaledGraph, LoopsCorrectScaleDrift) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CreepingWalk walk = CreepingWalkMaker(seed).walk(3);
    const double before_m = ate_m(walk);
    CreepingWalk rigid = walk;
    rigid.graph.log_scales.clear();
    solve_pose_graph(rigid.graph, {.loop_loss = LoopLoss::kLeastSquares});
    const PoseGraphSummary summary = solve_pose_graph(walk.graph, {});
    EXPECT_LT(ate_m(walk), 0.1 * before_m) << "seed " << seed;
    EXPECT_LT(ate_m(walk), 0.25 * ate_m(rigid)) << "seed " << seed;
    int num_refused = 0;
    for (const double weight : summary.weights) num_refused += weight == 0.0 ? 1 : 0;
    EXPECT_LE(num_refused, 4) << "of 80 true loops, one in a hundred is expected; seed " << seed;
    const double last = walk.graph.log_scales.back();
    EXPECT_NEAR(last, walk.true_log_scales.back(), 0.2) << "seed " << seed;
  }
}

TEST(ScaledGraph, ALoopOfAnotherScaleIsRejected) {
  CreepingWalk walk = CreepingWalkMaker(7).walk(2);
  PoseEdge& last = walk.graph.edges.back();
  last.log_scale += 1.0;
  const PoseGraphSummary summary = solve_pose_graph(walk.graph, {});
  EXPECT_EQ(summary.weights.back(), 0.0);
}

TEST(ScaledGraph, WithEqualUnitsItEqualsTheRigidGraph) {
  core::Random random(9);
  PoseGraph graph;
  graph.world_from_node = {core::Rigid3{}};
  for (int i = 1; i < 6; ++i) {
    const core::Rigid3 step{core::exp_so3({0.0, 0.4, 0.0}), {0.0, 0.0, 1.0}};
    graph.world_from_node.push_back(graph.world_from_node.back() *
                                    core::exp_r3so3(random_tangent(random, 0.1, 0.1)) * step);
    graph.edges.push_back({i - 1, i, step});
  }
  graph.edges.push_back({0, 5, core::exp_r3so3(random_tangent(random, 1.0, 0.5))});
  PoseGraph scaled = graph;
  scaled.log_scales.assign(graph.world_from_node.size(), 0.0);
  for (auto& edge : scaled.edges) edge.scale_information = 1e12;
  solve_pose_graph(graph, {});
  solve_pose_graph(scaled, {});
  for (std::size_t i = 0; i < graph.world_from_node.size(); ++i)
    EXPECT_LT(core::log_r3so3(inverse(graph.world_from_node[i]) * scaled.world_from_node[i]).norm(),
              1e-4);
}

TEST(ScaledGraph, RefusesScalesOfSomeNodesAndInThePlane) {
  PoseGraph graph = CreepingWalkMaker(1).walk(2).graph;
  PoseGraph planar = graph;
  planar.is_planar = true;
  EXPECT_THROW(solve_pose_graph(planar, {}), core::ContractError);
  graph.log_scales.pop_back();
  EXPECT_THROW(solve_pose_graph(graph, {}), core::ContractError);
}

}  // namespace
}  // namespace samewhere::optimize
