#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/optimize/spanning_tree.hpp>

namespace samewhere::optimize {
namespace {

core::Rigid3 any_pose(core::Random& random) {
  core::Vector6d tangent;
  for (int i = 0; i < 6; ++i) tangent(i) = random.uniform(-2.0, 2.0);
  return core::exp_r3so3(tangent);
}

// Nodes at random poses, with edges of the true relative poses.
class SpanningTreeGuess : public testing::Test {
 protected:
  // With scales: the unit of node i has this logarithm.
  void make(int num_nodes, const std::vector<double>& log_scales = {}) {
    core::Random random(1);
    for (int i = 0; i < num_nodes; ++i) {
      truth_.push_back(any_pose(random));
      graph_.world_from_node.push_back(any_pose(random));
    }
    graph_.world_from_node[0] = truth_[0];
    true_scales_ = log_scales;
    if (!log_scales.empty()) graph_.log_scales.assign(log_scales.size(), 0.0);
  }

  PoseEdge& join(int a, int b, bool is_loop = false) {
    const auto of_a = static_cast<std::size_t>(a);
    const auto of_b = static_cast<std::size_t>(b);
    PoseEdge edge{.a = a, .b = b, .a_from_b = inverse(truth_[of_a]) * truth_[of_b]};
    edge.is_loop = is_loop;
    if (!true_scales_.empty()) {
      edge.a_from_b.translation *= std::exp(-true_scales_[of_a]);
      edge.log_scale = true_scales_[of_b] - true_scales_[of_a];
    }
    return graph_.edges.emplace_back(edge);
  }

  double error_of(int node) const {
    const auto i = static_cast<std::size_t>(node);
    return core::log_r3so3(inverse(truth_[i]) * graph_.world_from_node[i]).norm();
  }

  std::vector<core::Rigid3> truth_;
  std::vector<double> true_scales_;
  PoseGraph graph_;
};

TEST_F(SpanningTreeGuess, FollowsEdgesInBothDirections) {
  make(5);
  join(0, 1);
  join(2, 1);
  join(2, 3);
  join(4, 3);
  place_by_spanning_tree(graph_);
  for (int node = 0; node < 5; ++node) EXPECT_LT(error_of(node), 1e-9) << node;
}

TEST_F(SpanningTreeGuess, PrefersOdometryToLoops) {
  make(6);
  // a false loop from the first node to the last, and true odometry between them
  PoseEdge& outlier = join(0, 5, true);
  outlier.a_from_b.translation.x() += 3.0;
  for (int i = 1; i < 6; ++i) join(i - 1, i);
  place_by_spanning_tree(graph_);
  for (int node = 0; node < 6; ++node) EXPECT_LT(error_of(node), 1e-9) << node;
}

TEST_F(SpanningTreeGuess, UsesLoopsWhereOdometryEnds) {
  make(4);
  join(0, 1);
  join(1, 3, true);
  join(3, 2);
  place_by_spanning_tree(graph_);
  for (int node = 0; node < 4; ++node) EXPECT_LT(error_of(node), 1e-9) << node;
}

TEST_F(SpanningTreeGuess, KeepsFixedNodesAsRootsOfTheirComponent) {
  make(4);
  join(0, 1);
  join(2, 3);
  graph_.fixed_nodes = {1, 3};
  graph_.world_from_node[1] = truth_[1];
  graph_.world_from_node[0] = {};
  const core::Rigid3 elsewhere = graph_.world_from_node[3];
  place_by_spanning_tree(graph_);
  EXPECT_LT(error_of(0), 1e-9);
  EXPECT_EQ(graph_.world_from_node[3].translation, elsewhere.translation);
  const core::Rigid3 moved = elsewhere * inverse(truth_[3]) * truth_[2];
  EXPECT_LT(core::log_r3so3(inverse(moved) * graph_.world_from_node[2]).norm(), 1e-9);
}

TEST_F(SpanningTreeGuess, ComposesUnits) {
  make(4, {0.0, 0.2, -0.3, 0.1});
  join(0, 1);
  join(2, 1);
  join(2, 3);
  place_by_spanning_tree(graph_);
  for (int node = 0; node < 4; ++node) {
    EXPECT_LT(error_of(node), 1e-9) << node;
    const auto i = static_cast<std::size_t>(node);
    EXPECT_NEAR(graph_.log_scales[i], true_scales_[i], 1e-12);
  }
}

TEST_F(SpanningTreeGuess, RefusesAnEdgeToAMissingNode) {
  make(2);
  join(0, 1).b = 2;
  EXPECT_THROW(place_by_spanning_tree(graph_), core::ContractError);
}

}  // namespace
}  // namespace samewhere::optimize
