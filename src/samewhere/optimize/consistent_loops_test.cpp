#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/optimize/consistent_loops.hpp>

namespace samewhere::optimize {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kLimit = 16.81;

// Nodes a metre apart on a line, with odometry from each to the next, and loops across it.
class LoopsThatAgree : public testing::Test {
 protected:
  LoopsThatAgree() {
    for (int i = 0; i < 200; ++i)
      graph_.world_from_node.push_back({core::exp_so3({0, 0, 0}), {1.0 * i, 0.0, 0.0}});
    for (int i = 0; i < 199; ++i)
      graph_.edges.push_back(
          {.a = i, .b = i + 1, .a_from_b = {core::exp_so3({0, 0, 0}), {1.0, 0.0, 0.0}}});
  }
  // A loop that would put node b so far ahead of node a.
  std::size_t say(int a, int b, double ahead_m) {
    PoseEdge edge{.a = a, .b = b, .a_from_b = {core::exp_so3({0, 0, 0}), {ahead_m, 0.0, 0.0}}};
    edge.information = 400.0 * core::Matrix6d::Identity();  // 5 cm
    edge.is_loop = true;
    graph_.edges.push_back(edge);
    said_.push_back(graph_.edges.size() - 1);
    return said_.back();
  }

  PoseGraph graph_;
  std::vector<std::size_t> said_;
};

TEST_F(LoopsThatAgree, AreThoseThatPutOneStretchAtOnePlace) {
  const std::size_t one = say(10, 110, 3.0);
  say(10, 60, 3.0);
  const std::size_t other = say(14, 112, 1.0);  // four metres on, and two
  EXPECT_THAT(loops_that_agree(graph_, said_, kLimit), ElementsAre(ElementsAre(one, other)));
}

TEST_F(LoopsThatAgree, AreNotThoseThatContradictEachOther) {
  say(10, 110, 3.0);
  say(14, 112, 3.0);  // two metres off, where eight edges may err by 0.6
  EXPECT_THAT(loops_that_agree(graph_, said_, kLimit), IsEmpty());
}

TEST_F(LoopsThatAgree, MayBeFurtherOffTheMoreLiesBetween) {
  say(10, 110, 3.0);
  say(12, 110, 0.6);
  EXPECT_THAT(loops_that_agree(graph_, said_, kLimit).size(), 1U) << "0.4 m, of four edges";
  say(50, 190, 3.0);
  say(51, 190, 1.6);
  EXPECT_THAT(loops_that_agree(graph_, said_, kLimit).size(), 1U) << "0.4 m, of three";
}

TEST_F(LoopsThatAgree, OfDistantPlacesNobodyCanTell) {
  say(10, 110, 3.0);
  say(70, 170, 3.0);
  EXPECT_THAT(loops_that_agree(graph_, said_, kLimit), IsEmpty());
}

TEST_F(LoopsThatAgree, OfTwoWalksNobodyCanTellHoweverNearTheirNumbers) {
  say(98, 150, 3.0);
  say(101, 150, 0.0);
  EXPECT_THAT(loops_that_agree(graph_, said_, kLimit).size(), 1U) << "one walk";
  graph_.edges[99].is_loop = true;  // from 99 to 100
  EXPECT_THAT(loops_that_agree(graph_, said_, kLimit), IsEmpty());
}

TEST_F(LoopsThatAgree, TheLargestGroupComesFirst) {
  for (const int k : {0, 1}) say(10 + k, 60 + k, 0.0);
  for (const int k : {0, 1, 2}) say(80 + k, 160 + k, 5.0);
  EXPECT_THAT(
      loops_that_agree(graph_, said_, kLimit),
      ElementsAre(ElementsAre(said_[2], said_[3], said_[4]), ElementsAre(said_[0], said_[1])));
}

}  // namespace
}  // namespace samewhere::optimize
