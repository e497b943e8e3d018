#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/optimize/consistent_loops.hpp>

namespace samewhere::optimize {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kLimit = 16.81;

// Nodes one metre apart on a line, odometry from each to the next, and loops across it.
class ConsistentLoops : public testing::Test {
 protected:
  ConsistentLoops() {
    for (int i = 0; i < 200; ++i)
      graph_.world_from_node.push_back({core::exp_so3({0, 0, 0}), {1.0 * i, 0.0, 0.0}});
    for (int i = 0; i < 199; ++i)
      graph_.edges.push_back(
          {.a = i, .b = i + 1, .a_from_b = {core::exp_so3({0, 0, 0}), {1.0, 0.0, 0.0}}});
  }
  // A loop with node b so far ahead of node a.
  std::size_t add_loop(int a, int b, double ahead_m) {
    PoseEdge edge{.a = a, .b = b, .a_from_b = {core::exp_so3({0, 0, 0}), {ahead_m, 0.0, 0.0}}};
    edge.information = 400.0 * core::Matrix6d::Identity();  // 5 cm
    edge.is_loop = true;
    graph_.edges.push_back(edge);
    loops_.push_back(graph_.edges.size() - 1);
    return loops_.back();
  }

  PoseGraph graph_;
  std::vector<std::size_t> loops_;
};

TEST_F(ConsistentLoops, ShareTheRelativePoseOfTwoSegments) {
  const std::size_t one = add_loop(10, 110, 3.0);
  add_loop(10, 60, 3.0);
  const std::size_t other = add_loop(14, 112, 1.0);  // four metres ahead, and two
  EXPECT_THAT(consistent_loops(graph_, loops_, kLimit, {}), ElementsAre(ElementsAre(one, other)));
}

TEST_F(ConsistentLoops, ExcludeContradictingOnes) {
  add_loop(10, 110, 3.0);
  add_loop(14, 112, 3.0);  // two metres off, limit 0.6 for eight edges
  EXPECT_THAT(consistent_loops(graph_, loops_, kLimit, {}), IsEmpty());
}

TEST_F(ConsistentLoops, HaveALimitThatGrowsWithTheEdgesBetween) {
  add_loop(10, 110, 3.0);
  add_loop(12, 110, 0.6);
  EXPECT_THAT(consistent_loops(graph_, loops_, kLimit, {}).size(), 1U) << "0.4 m, of four edges";
  add_loop(50, 190, 3.0);
  add_loop(51, 190, 1.6);
  EXPECT_THAT(consistent_loops(graph_, loops_, kLimit, {}).size(), 1U) << "0.4 m, of three";
}

TEST_F(ConsistentLoops, EndAtTheLargestGap) {
  add_loop(10, 110, 3.0);
  add_loop(70, 170, 3.0);
  EXPECT_THAT(consistent_loops(graph_, loops_, kLimit, {}), IsEmpty());
}

TEST_F(ConsistentLoops, NeedOdometryBetweenTheirEnds) {
  add_loop(98, 150, 3.0);
  add_loop(101, 150, 0.0);
  EXPECT_THAT(consistent_loops(graph_, loops_, kLimit, {}).size(), 1U) << "one session";
  graph_.edges[99].is_loop = true;  // from 99 to 100
  EXPECT_THAT(consistent_loops(graph_, loops_, kLimit, {}), IsEmpty());
}

TEST_F(ConsistentLoops, AreSortedByTheSizeOfTheGroup) {
  for (const int k : {0, 1}) add_loop(10 + k, 60 + k, 0.0);
  for (const int k : {0, 1, 2}) add_loop(80 + k, 160 + k, 5.0);
  EXPECT_THAT(
      consistent_loops(graph_, loops_, kLimit, {}),
      ElementsAre(ElementsAre(loops_[2], loops_[3], loops_[4]), ElementsAre(loops_[0], loops_[1])));
}

}  // namespace
}  // namespace samewhere::optimize
