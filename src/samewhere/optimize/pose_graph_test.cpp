#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {
namespace {

constexpr double kStepSigma_m = 0.05;
constexpr double kStepSigma_rad = 0.01;

core::Rigid3 noise(core::Random& random) {
  core::Vector6d tangent;
  for (int i = 0; i < 6; ++i)
    tangent(i) = (i < 3 ? kStepSigma_m : kStepSigma_rad) * random.gaussian();
  return core::exp_r3so3(tangent);
}

core::Matrix6d honest_information() {
  core::Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(kStepSigma_m), Eigen::Vector3d::Constant(kStepSigma_rad);
  return sigma.cwiseAbs2().cwiseInverse().asDiagonal();
}

// Laps around a square, with a loop from each pose of a later lap to the same place of the one
// before.
struct Laps {
  PoseGraph graph;
  std::vector<core::Rigid3> truth;
  int num_loops = 0;
};

constexpr int kLapSteps = 40;

Laps laps(core::Random& random, int num_laps) {
  Laps walk;
  walk.truth = {core::Rigid3{}};
  PoseGraph& graph = walk.graph;
  graph.world_from_node = walk.truth;
  const auto add = [&](int a, int b, const core::Rigid3& a_from_b, bool is_loop) {
    graph.edges.push_back({a, b, a_from_b, honest_information(), is_loop});
  };
  for (int i = 1; i < num_laps * kLapSteps; ++i) {
    const core::Rigid3 step{core::exp_so3({0.0, i % 10 == 0 ? 1.5707963 : 0.0, 0.0}),
                            {0.0, 0.0, 1.0}};
    walk.truth.push_back(walk.truth.back() * step);
    add(i - 1, i, step * noise(random), false);
    graph.world_from_node.push_back(graph.world_from_node.back() * graph.edges.back().a_from_b);
  }
  for (int i = kLapSteps; i < num_laps * kLapSteps; ++i) {
    const auto at = [&](int node) { return walk.truth[static_cast<std::size_t>(node)]; };
    add(i - kLapSteps, i, inverse(at(i - kLapSteps)) * at(i) * noise(random), true);
    ++walk.num_loops;
  }
  return walk;
}

double ate_m(const Laps& walk) {
  double sum = 0.0;
  for (std::size_t i = 0; i < walk.truth.size(); ++i) {
    sum += (walk.graph.world_from_node[i].translation - walk.truth[i].translation).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(walk.truth.size()));
}

// Replaces a share of the loops by lies and returns which.
std::vector<bool> lie(PoseGraph& graph, double share, core::Random& random, bool is_consistent) {
  std::vector<bool> is_lie(graph.edges.size(), false);
  // one wrong belief for all: the place is three metres farther on
  const core::Rigid3 shift{Eigen::Quaterniond::Identity(), {0.0, 0.0, 3.0}};
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    PoseEdge& edge = graph.edges[i];
    if (!edge.is_loop || random.uniform(0.0, 1.0) > share) continue;
    is_lie[i] = true;
    if (is_consistent) {
      edge.a_from_b = shift * edge.a_from_b;
    } else {
      edge.a = static_cast<int>(random.uniform(0.0, edge.b - 5.0));
    }
  }
  return is_lie;
}

struct LieCase {
  double share;
  bool is_consistent;
};

// The graph without the edges that lie.
Laps without(const Laps& walk, const std::vector<bool>& is_lie) {
  Laps rest = walk;
  rest.graph.edges.clear();
  for (std::size_t i = 0; i < is_lie.size(); ++i)
    if (!is_lie[i]) rest.graph.edges.push_back(walk.graph.edges[i]);
  return rest;
}

TEST(PoseGraphOfLies, IsAsGoodAsTheOneWithoutThem) {
  for (const LieCase& lies : {LieCase{0.05, false}, {0.5, false}, {0.2, true}}) {
    core::Random random(11);
    Laps walk = laps(random, 4);
    const std::vector<bool> is_lie = lie(walk.graph, lies.share, random, lies.is_consistent);
    Laps honest = without(walk, is_lie);
    solve_pose_graph(honest.graph, {});
    Laps trusting = walk;
    solve_pose_graph(trusting.graph, {.loop_loss = LoopLoss::kLeastSquares});
    const PoseGraphSummary summary = solve_pose_graph(walk.graph, {});

    int num_true_refused = 0;
    for (std::size_t i = 0; i < is_lie.size(); ++i) {
      if (is_lie[i]) {
        EXPECT_EQ(summary.weights[i], 0.0) << "share " << lies.share << " edge " << i;
      }
      if (!is_lie[i] && summary.weights[i] == 0.0) ++num_true_refused;
    }
    EXPECT_LE(num_true_refused, 0.05 * walk.num_loops) << "one of a hundred is expected";
    EXPECT_LT(ate_m(walk), 1.02 * ate_m(honest)) << "share " << lies.share;
    EXPECT_GT(ate_m(trusting), 3.0 * ate_m(honest)) << "share " << lies.share;
  }
}

// All loops of a stretch of the path say that it lies 3 m elsewhere, as those of a corridor do that
// looks like another.
std::vector<bool> lie_from_to(Laps& walk, int first, int last) {
  std::vector<bool> is_lie(walk.graph.edges.size(), false);
  const core::Rigid3 shift{Eigen::Quaterniond::Identity(), {3.0, 0.0, 0.0}};
  for (std::size_t i = 0; i < is_lie.size(); ++i) {
    PoseEdge& edge = walk.graph.edges[i];
    if (!edge.is_loop || edge.b < first || edge.b > last) continue;
    const core::Rigid3& a = walk.truth[static_cast<std::size_t>(edge.a)];
    edge.a_from_b = inverse(a) * shift * a * edge.a_from_b;
    is_lie[i] = true;
  }
  return is_lie;
}

TEST(PoseGraphOfLies, AStretchThatLiesAlikeCountsAsOneLie) {
  for (const std::uint64_t seed : {31, 32}) {
    core::Random random(seed);
    Laps walk = laps(random, 6);
    const std::vector<bool> is_lie = lie_from_to(walk, 110, 149);  // a fifth of all
    Laps honest = without(walk, is_lie);
    solve_pose_graph(honest.graph, {});
    const PoseGraphSummary summary = solve_pose_graph(walk.graph, {});

    int num_true_refused = 0;
    double cost = 0.0;
    for (std::size_t i = 0; i < is_lie.size(); ++i) {
      if (is_lie[i]) {
        EXPECT_EQ(summary.weights[i], 0.0) << "seed " << seed << " edge " << i;
      }
      if (!is_lie[i] && summary.weights[i] == 0.0) ++num_true_refused;
      cost += 0.5 * summary.weights[i] * chi2_of(walk.graph, walk.graph.edges[i]);
    }
    EXPECT_LE(num_true_refused, 0.05 * walk.num_loops) << "seed " << seed;
    EXPECT_LT(ate_m(walk), 1.1 * ate_m(honest)) << "seed " << seed;
    EXPECT_NEAR(summary.final_cost, cost, 1e-6 * cost) << "seed " << seed;
  }
}

// Dynamic covariance scaling is not among them: from a start that drifted far it believes too few.
TEST(PoseGraphOfLies, WithoutLiesItFindsWhatTheOthersFind) {
  core::Random random(12);
  const Laps walk = laps(random, 3);
  Laps squares = walk;
  solve_pose_graph(squares.graph, {.loop_loss = LoopLoss::kLeastSquares});
  for (const LoopLoss loss : {LoopLoss::kHuber, LoopLoss::kGnc, LoopLoss::kGncEach}) {
    Laps robust = walk;
    solve_pose_graph(robust.graph, {.loop_loss = loss});
    EXPECT_LT(ate_m(robust), 1.05 * ate_m(squares)) << static_cast<int>(loss);
  }
}

// What tells ours from it: to it, loops that lie alike are many.
TEST(PoseGraphOfLies, TheMethodAsPublishedRefusesLiesAtRandomAndBelievesThoseThatAgree) {
  core::Random random(31);
  Laps walk = laps(random, 6);
  Laps of_stretch = walk;
  const std::vector<bool> is_stretch = lie_from_to(of_stretch, 110, 149);
  const std::vector<bool> is_random = lie(walk.graph, 0.2, random, false);
  const auto num_believed = [](Laps& graph, const std::vector<bool>& is_lie) {
    const PoseGraphSummary summary =
        solve_pose_graph(graph.graph, {.loop_loss = LoopLoss::kGncEach});
    int num = 0;
    for (std::size_t i = 0; i < is_lie.size(); ++i) num += is_lie[i] && summary.weights[i] > 0.5;
    return num;
  };
  EXPECT_LE(num_believed(walk, is_random), 2) << "some are nearly true by chance";
  EXPECT_GE(num_believed(of_stretch, is_stretch), 20) << "of 40";
}

TEST(PoseGraphOfLies, OneInDoubtIsAskedWhenTheRestFitsAndWhenItDoesNot) {
  core::Random random(16);
  const Laps walk = laps(random, 3);
  const auto loop = static_cast<std::size_t>(3 * kLapSteps - 1);  // the first of them
  Laps true_one = walk;
  true_one.graph.edges[loop].is_doubted = true;
  EXPECT_EQ(solve_pose_graph(true_one.graph, {}).weights[loop], 1.0);
  Laps false_one = true_one;
  false_one.graph.edges[loop].a_from_b.translation.x() += 20.0;
  EXPECT_EQ(solve_pose_graph(false_one.graph, {}).weights[loop], 0.0);
  std::vector<bool> is_lie(walk.graph.edges.size(), false);
  is_lie[loop] = true;
  Laps honest = without(walk, is_lie);
  solve_pose_graph(honest.graph, {});
  EXPECT_NEAR(ate_m(false_one), ate_m(honest), 1e-3);
  // another lies, too
  false_one.graph.edges[loop + 9].a_from_b.translation.x() += 20.0;
  Laps of_two = true_one;
  of_two.graph.edges[loop + 9] = false_one.graph.edges[loop + 9];
  const std::vector<double> of_one_lie = solve_pose_graph(of_two.graph, {}).weights;
  EXPECT_EQ(of_one_lie[loop], 1.0);
  EXPECT_EQ(of_one_lie[loop + 9], 0.0);
  const std::vector<double> weights = solve_pose_graph(false_one.graph, {}).weights;
  EXPECT_EQ(weights[loop], 0.0);
  EXPECT_EQ(weights[loop + 9], 0.0);
}

// What asking all in full would take is spared while one lies alone, in doubt or not.
TEST(PoseGraphOfLies, OneLieIsFoundWithoutAskingAll) {
  core::Random random(16);
  const Laps walk = laps(random, 3);
  const auto loop = static_cast<std::size_t>(3 * kLapSteps - 1);
  Laps of_one = walk;
  of_one.graph.edges[loop].a_from_b.translation.x() += 20.0;
  Laps of_two = of_one;
  of_two.graph.edges[loop + 9].a_from_b.translation.x() += 20.0;
  Laps in_doubt = of_one;
  in_doubt.graph.edges[loop].is_doubted = true;
  const int num_of_all = solve_pose_graph(of_two.graph, {}).num_iterations;
  for (Laps* spared : {&of_one, &in_doubt}) {
    const PoseGraphSummary summary = solve_pose_graph(spared->graph, {});
    EXPECT_LT(3 * summary.num_iterations, num_of_all);
    for (std::size_t i = 0; i < summary.weights.size(); ++i)
      EXPECT_EQ(summary.weights[i], i == loop ? 0.0 : 1.0) << "edge " << i;
  }
}

// Alone, the loop not in doubt is bent a little too much; together they bend the odometry.
TEST(PoseGraphOfLies, ALoopThatFitsOnlyBesideOneInDoubtIsBelievedWithIt) {
  constexpr int kSteps = 10;
  const Config config;
  const double gap_m = kStepSigma_m * (kSteps + 1) * std::sqrt(1.05 * config.loop_chi2);
  PoseGraph graph;
  graph.world_from_node = {core::Rigid3{}};
  const core::Rigid3 step{Eigen::Quaterniond::Identity(), {0.0, 0.0, 1.0}};
  for (int i = 1; i <= kSteps; ++i) {
    graph.world_from_node.push_back(graph.world_from_node.back() * step);
    graph.edges.push_back({i - 1, i, step, honest_information(), false});
  }
  const core::Rigid3 told{Eigen::Quaterniond::Identity(), {0.0, 0.0, kSteps + gap_m}};
  graph.edges.push_back({0, kSteps, told, honest_information(), true});
  PoseGraph alone = graph;
  EXPECT_EQ(solve_pose_graph(alone, config).weights.back(), 0.0);
  graph.edges.push_back(graph.edges.back());
  graph.edges.back().is_doubted = true;
  const std::vector<double> weights = solve_pose_graph(graph, config).weights;
  EXPECT_EQ(weights[kSteps], 1.0);
  EXPECT_EQ(weights[kSteps + 1], 1.0);
}

// A long way out that comes back once, closed by loops near its end, as far off as all of them say
// alike, and by lies at random that agree with nobody.
struct LongWay {
  Laps walk;
  std::size_t first_at_end = 0;  // edge
};

LongWay long_way(core::Random& random, int num_at_end, double off_m) {
  constexpr int kSide = 100;
  constexpr int kNumLies = 30;
  LongWay way;
  PoseGraph& graph = way.walk.graph;
  std::vector<core::Rigid3>& truth = way.walk.truth;
  truth = graph.world_from_node = {core::Rigid3{}};
  const auto join = [&](int a, int b, const core::Rigid3& a_from_b, bool is_loop) {
    graph.edges.push_back({a, b, a_from_b * noise(random), honest_information(), is_loop});
  };
  for (int i = 1; i <= 4 * kSide; ++i) {
    const core::Rigid3 step{core::exp_so3({0.0, i % kSide == 0 ? 1.5707963 : 0.0, 0.0}),
                            {0.0, 0.0, 1.0}};
    truth.push_back(truth.back() * step);
    join(i - 1, i, step, false);
    graph.world_from_node.push_back(graph.world_from_node.back() * graph.edges.back().a_from_b);
  }
  for (int i = 0; i < kNumLies; ++i) {
    const int b = static_cast<int>(random.uniform(20.0, 4.0 * kSide));
    join(static_cast<int>(random.uniform(0.0, b - 10.0)), b, {}, true);
  }
  way.first_at_end = graph.edges.size();
  const core::Rigid3 off{core::exp_so3({0.0, 0.0, 0.0}), {0.0, off_m, 0.0}};
  for (int i = 0; i < num_at_end; ++i) {
    const int query = 4 * kSide - 6 * i;
    join(6 * i, query,
         inverse(truth[static_cast<std::size_t>(6 * i)]) * off *
             truth[static_cast<std::size_t>(query)],
         true);
  }
  return way;
}

// How many of those at the end are believed; none of the lies at random may be.
int num_believed_at_end(LongWay way) {
  const PoseGraphSummary summary = solve_pose_graph(way.walk.graph, {});
  int count = 0;
  for (std::size_t i = 0; i < way.walk.graph.edges.size(); ++i) {
    const bool is_believed = way.walk.graph.edges[i].is_loop && summary.weights[i] > 0.0;
    if (i >= way.first_at_end) count += is_believed;
    EXPECT_FALSE(is_believed && i < way.first_at_end) << i;
  }
  return count;
}

TEST(PoseGraphOfLies, TwoThatAgreeAreAskedTogetherWhereEachAloneWouldBeRefused) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    core::Random random(seed);
    const LongWay way = long_way(random, 2, 0.0);
    EXPECT_EQ(num_believed_at_end(way), 2) << seed;
    for (const std::size_t other : {way.first_at_end, way.first_at_end + 1}) {
      LongWay alone = way;
      alone.walk.graph.edges.erase(alone.walk.graph.edges.begin() +
                                   static_cast<std::ptrdiff_t>(other));
      EXPECT_EQ(num_believed_at_end(alone), 0) << seed;
    }
  }
}

TEST(PoseGraphOfLies, ThoseThatAreAskedTogetherAreOneClaim) {
  const auto num_believed = [](double off_m) {
    core::Random random(1);
    return num_believed_at_end(long_way(random, 6, off_m));
  };
  EXPECT_GE(num_believed(10.0), 5) << "odometry may err that much";
  EXPECT_EQ(num_believed(30.0), 0) << "each alone would not be believed, and six are no more";
}

TEST(PoseGraphOfLies, TheOnlyLoopIsBelievedIfOdometryMayErrThatMuch) {
  core::Random random(13);
  Laps walk = laps(random, 2);
  walk.graph.edges.resize(static_cast<std::size_t>(2 * kLapSteps));  // odometry and the first loop
  Laps wrong = walk;
  EXPECT_EQ(solve_pose_graph(walk.graph, {}).weights.back(), 1.0);
  wrong.graph.edges.back().a_from_b.translation.x() += 20.0;
  EXPECT_EQ(solve_pose_graph(wrong.graph, {}).weights.back(), 0.0);
}

TEST(PoseGraph, PartsAreSolvedEachByItself) {
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

TEST(PoseGraph, WhatIsFixedStaysAndHoldsItsPart) {
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
