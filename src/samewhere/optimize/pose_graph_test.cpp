#include <vector>

#include <gtest/gtest.h>

#include <samewhere/optimize/test_laps.hpp>

namespace samewhere::optimize {
namespace {

TEST(PoseGraph, ConnectedComponentsAreIndependent) {
  core::Random random(14);
  Laps walk = laps(random, 2);
  PoseGraph& graph = walk.graph;
  const int offset = static_cast<int>(graph.world_from_node.size());
  const PoseGraph once = graph;
  const core::Rigid3 elsewhere{core::exp_so3({0.3, 0.0, 0.0}), {100.0, 0.0, 0.0}};
  for (const auto& pose : once.world_from_node) graph.world_from_node.push_back(elsewhere * pose);
  for (PoseEdge edge : once.edges) {
    edge.a += offset;
    edge.b += offset;
    graph.edges.push_back(edge);
  }
  EXPECT_EQ(held_nodes(graph), (std::vector<int>{0, offset}));
  solve_pose_graph(graph, {});
  for (int i = 0; i < offset; ++i) {
    const auto first = graph.world_from_node[static_cast<std::size_t>(i)];
    const auto second = graph.world_from_node[static_cast<std::size_t>(i + offset)];
    EXPECT_LT(core::log_r3so3(inverse(elsewhere * first) * second).norm(), 1e-4);
  }
}

TEST(PoseGraph, AFixedNodeKeepsItsPoseAndTheGaugeOfItsComponent) {
  core::Random random(15);
  Laps walk = laps(random, 2);
  walk.graph.fixed_nodes = {7};
  const core::Rigid3 before = walk.graph.world_from_node[7];
  const core::Rigid3 first = walk.graph.world_from_node[0];
  solve_pose_graph(walk.graph, {});
  EXPECT_LT(core::log_r3so3(inverse(before) * walk.graph.world_from_node[7]).norm(), 1e-12);
  EXPECT_GT((walk.graph.world_from_node[0].translation - first.translation).norm(), 1e-3);
}

}  // namespace
}  // namespace samewhere::optimize
