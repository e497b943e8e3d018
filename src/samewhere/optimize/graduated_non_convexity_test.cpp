#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/optimize/test_laps.hpp>

namespace samewhere::optimize {
namespace {

// Replaces a share of the loops by outliers and returns which.
std::vector<bool> add_outliers(PoseGraph& graph, double share, core::Random& random,
                               bool is_consistent) {
  std::vector<bool> is_outlier(graph.edges.size(), false);
  // one false hypothesis for all: the place is three metres ahead
  const core::Rigid3 shift{Eigen::Quaterniond::Identity(), {0.0, 0.0, 3.0}};
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    PoseEdge& edge = graph.edges[i];
    if (!edge.is_loop || random.uniform(0.0, 1.0) > share) continue;
    is_outlier[i] = true;
    if (is_consistent) {
      edge.a_from_b = shift * edge.a_from_b;
    } else {
      edge.a = static_cast<int>(random.uniform(0.0, edge.b - 5.0));
    }
  }
  return is_outlier;
}

struct OutlierCase {
  double share;
  bool is_consistent;
};

// The graph without the outliers.
Laps without(const Laps& walk, const std::vector<bool>& is_outlier) {
  Laps rest = walk;
  rest.graph.edges.clear();
  for (std::size_t i = 0; i < is_outlier.size(); ++i)
    if (!is_outlier[i]) rest.graph.edges.push_back(walk.graph.edges[i]);
  return rest;
}

TEST(RobustPoseGraph, IsAsAccurateAsTheGraphWithoutOutliers) {
  for (const OutlierCase& outliers : {OutlierCase{0.05, false}, {0.5, false}, {0.2, true}}) {
    core::Random random(11);
    Laps walk = laps(random, 4);
    const std::vector<bool> is_outlier =
        add_outliers(walk.graph, outliers.share, random, outliers.is_consistent);
    Laps inliers = without(walk, is_outlier);
    solve_pose_graph(inliers.graph, {});
    Laps least_squares = walk;
    solve_pose_graph(least_squares.graph, {.loop_loss = LoopLoss::kLeastSquares});
    const PoseGraphSummary summary = solve_pose_graph(walk.graph, {});

    int num_true_rejected = 0;
    for (std::size_t i = 0; i < is_outlier.size(); ++i) {
      if (is_outlier[i]) {
        EXPECT_EQ(summary.weights[i], 0.0) << "share " << outliers.share << " edge " << i;
      }
      if (!is_outlier[i] && summary.weights[i] == 0.0) ++num_true_rejected;
    }
    EXPECT_LE(num_true_rejected, 0.05 * walk.num_loops) << "one of a hundred is expected";
    EXPECT_LT(ate_m(walk), 1.02 * ate_m(inliers)) << "share " << outliers.share;
    EXPECT_GT(ate_m(least_squares), 3.0 * ate_m(inliers)) << "share " << outliers.share;
  }
}

// All loops of a segment of the trajectory are off by the same 3 m, as in a corridor that looks
// like another.
std::vector<bool> shift_loops_from_to(Laps& walk, int first, int last) {
  std::vector<bool> is_outlier(walk.graph.edges.size(), false);
  const core::Rigid3 shift{Eigen::Quaterniond::Identity(), {3.0, 0.0, 0.0}};
  for (std::size_t i = 0; i < is_outlier.size(); ++i) {
    PoseEdge& edge = walk.graph.edges[i];
    if (!edge.is_loop || edge.b < first || edge.b > last) continue;
    const core::Rigid3& a = walk.truth[static_cast<std::size_t>(edge.a)];
    edge.a_from_b = inverse(a) * shift * a * edge.a_from_b;
    is_outlier[i] = true;
  }
  return is_outlier;
}

TEST(RobustPoseGraph, ASegmentOfConsistentOutliersIsOneHypothesis) {
  for (const std::uint64_t seed : {31, 32}) {
    core::Random random(seed);
    Laps walk = laps(random, 6);
    const std::vector<bool> is_outlier = shift_loops_from_to(walk, 110, 149);  // a fifth of all
    Laps inliers = without(walk, is_outlier);
    solve_pose_graph(inliers.graph, {});
    const PoseGraphSummary summary = solve_pose_graph(walk.graph, {});

    int num_true_rejected = 0;
    double cost = 0.0;
    for (std::size_t i = 0; i < is_outlier.size(); ++i) {
      if (is_outlier[i]) {
        EXPECT_EQ(summary.weights[i], 0.0) << "seed " << seed << " edge " << i;
      }
      if (!is_outlier[i] && summary.weights[i] == 0.0) ++num_true_rejected;
      cost += 0.5 * summary.weights[i] * chi2_of(walk.graph, walk.graph.edges[i]);
    }
    EXPECT_LE(num_true_rejected, 0.05 * walk.num_loops) << "seed " << seed;
    EXPECT_LT(ate_m(walk), 1.1 * ate_m(inliers)) << "seed " << seed;
    EXPECT_NEAR(summary.final_cost, cost, 1e-6 * cost) << "seed " << seed;
  }
}

TEST(RobustPoseGraph, WithoutSegmentsConsistentOutliersCountByTheirNumber) {
  core::Random random(31);
  Laps walk = laps(random, 6);
  const std::vector<bool> is_outlier = shift_loops_from_to(walk, 110, 149);
  Config config;
  config.loop_segments.max_segments = 0;
  const PoseGraphSummary summary = solve_pose_graph(walk.graph, config);
  int num_accepted = 0;
  for (std::size_t i = 0; i < is_outlier.size(); ++i)
    num_accepted += is_outlier[i] && summary.weights[i] > 0.0;
  EXPECT_GE(num_accepted, 20) << "of 40";
}

// Dynamic covariance scaling is not among them: from initial poses with much drift it accepts too
// few.
TEST(RobustPoseGraph, WithoutOutliersAllLossesFindTheSameSolution) {
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

// The difference to our method: consistent outliers count by their number.
TEST(RobustPoseGraph, AsPublishedRejectsRandomOutliersAndAcceptsConsistentOnes) {
  core::Random random(31);
  Laps walk = laps(random, 6);
  Laps of_segment = walk;
  const std::vector<bool> is_segment = shift_loops_from_to(of_segment, 110, 149);
  const std::vector<bool> is_random = add_outliers(walk.graph, 0.2, random, false);
  const auto num_accepted = [](Laps& graph, const std::vector<bool>& is_outlier) {
    const PoseGraphSummary summary =
        solve_pose_graph(graph.graph, {.loop_loss = LoopLoss::kGncEach});
    int num = 0;
    for (std::size_t i = 0; i < is_outlier.size(); ++i)
      num += is_outlier[i] && summary.weights[i] > 0.5;
    return num;
  };
  EXPECT_LE(num_accepted(walk, is_random), 2) << "some are nearly true by chance";
  EXPECT_GE(num_accepted(of_segment, is_segment), 20) << "of 40";
}

TEST(RobustPoseGraph, ASuspendedLoopIsTestedWhetherTheRestFitsOrNot) {
  core::Random random(16);
  const Laps walk = laps(random, 3);
  const auto loop = static_cast<std::size_t>(3 * kLapSteps - 1);  // the first of them
  Laps true_one = walk;
  true_one.graph.edges[loop].is_suspended = true;
  EXPECT_EQ(solve_pose_graph(true_one.graph, {}).weights[loop], 1.0);
  Laps false_one = true_one;
  false_one.graph.edges[loop].a_from_b.translation.x() += 20.0;
  EXPECT_EQ(solve_pose_graph(false_one.graph, {}).weights[loop], 0.0);
  std::vector<bool> is_outlier(walk.graph.edges.size(), false);
  is_outlier[loop] = true;
  Laps inliers = without(walk, is_outlier);
  solve_pose_graph(inliers.graph, {});
  EXPECT_NEAR(ate_m(false_one), ate_m(inliers), 1e-3);
  // a second outlier
  false_one.graph.edges[loop + 9].a_from_b.translation.x() += 20.0;
  Laps of_two = true_one;
  of_two.graph.edges[loop + 9] = false_one.graph.edges[loop + 9];
  const std::vector<double> with_one_outlier = solve_pose_graph(of_two.graph, {}).weights;
  EXPECT_EQ(with_one_outlier[loop], 1.0);
  EXPECT_EQ(with_one_outlier[loop + 9], 0.0);
  const std::vector<double> weights = solve_pose_graph(false_one.graph, {}).weights;
  EXPECT_EQ(weights[loop], 0.0);
  EXPECT_EQ(weights[loop + 9], 0.0);
}

// The full procedure is not needed for a single outlier, suspended or not.
TEST(RobustPoseGraph, ASingleOutlierIsRejectedWithoutTheFullProcedure) {
  core::Random random(16);
  const Laps walk = laps(random, 3);
  const auto loop = static_cast<std::size_t>(3 * kLapSteps - 1);
  Laps of_one = walk;
  of_one.graph.edges[loop].a_from_b.translation.x() += 20.0;
  Laps of_two = of_one;
  of_two.graph.edges[loop + 9].a_from_b.translation.x() += 20.0;
  Laps suspended = of_one;
  suspended.graph.edges[loop].is_suspended = true;
  const int num_in_full = solve_pose_graph(of_two.graph, {}).num_iterations;
  for (Laps* single : {&of_one, &suspended}) {
    const PoseGraphSummary summary = solve_pose_graph(single->graph, {});
    EXPECT_LT(3 * summary.num_iterations, num_in_full);
    for (std::size_t i = 0; i < summary.weights.size(); ++i)
      EXPECT_EQ(summary.weights[i], i == loop ? 0.0 : 1.0) << "edge " << i;
  }
}

// Alone, the loop that is not suspended has a squared error slightly above the limit; together they
// outweigh the odometry.
TEST(RobustPoseGraph, ALoopThatFitsOnlyWithASuspendedOneIsAcceptedWithIt) {
  constexpr int kSteps = 10;
  const Config config;
  const double gap_m = kStepSigma_m * (kSteps + 1) * std::sqrt(1.05 * config.loop_chi2);
  PoseGraph graph;
  graph.world_from_node = {core::Rigid3{}};
  const core::Rigid3 step{Eigen::Quaterniond::Identity(), {0.0, 0.0, 1.0}};
  for (int i = 1; i <= kSteps; ++i) {
    graph.world_from_node.push_back(graph.world_from_node.back() * step);
    graph.edges.push_back({i - 1, i, step, noise_information(), false});
  }
  const core::Rigid3 measured{Eigen::Quaterniond::Identity(), {0.0, 0.0, kSteps + gap_m}};
  graph.edges.push_back({0, kSteps, measured, noise_information(), true});
  PoseGraph alone = graph;
  EXPECT_EQ(solve_pose_graph(alone, config).weights.back(), 0.0);
  graph.edges.push_back(graph.edges.back());
  graph.edges.back().is_suspended = true;
  const std::vector<double> weights = solve_pose_graph(graph, config).weights;
  EXPECT_EQ(weights[kSteps], 1.0);
  EXPECT_EQ(weights[kSteps + 1], 1.0);
}

// One long lap, closed by consistent loops near its end, all off by the same offset, and by random
// outliers.
struct LongLap {
  Laps walk;
  std::size_t first_at_end = 0;  // edge
};

LongLap long_lap(core::Random& random, int num_at_end, double off_m) {
  constexpr int kSide = 100;
  constexpr int kNumOutliers = 30;
  LongLap lap;
  PoseGraph& graph = lap.walk.graph;
  std::vector<core::Rigid3>& truth = lap.walk.truth;
  truth = graph.world_from_node = {core::Rigid3{}};
  const auto join = [&](int a, int b, const core::Rigid3& a_from_b, bool is_loop) {
    graph.edges.push_back({a, b, a_from_b * odometry_noise(random), noise_information(), is_loop});
  };
  for (int i = 1; i <= 4 * kSide; ++i) {
    const core::Rigid3 step{core::exp_so3({0.0, i % kSide == 0 ? 1.5707963 : 0.0, 0.0}),
                            {0.0, 0.0, 1.0}};
    truth.push_back(truth.back() * step);
    join(i - 1, i, step, false);
    graph.world_from_node.push_back(graph.world_from_node.back() * graph.edges.back().a_from_b);
  }
  for (int i = 0; i < kNumOutliers; ++i) {
    const int b = static_cast<int>(random.uniform(20.0, 4.0 * kSide));
    join(static_cast<int>(random.uniform(0.0, b - 10.0)), b, {}, true);
  }
  lap.first_at_end = graph.edges.size();
  const core::Rigid3 off{core::exp_so3({0.0, 0.0, 0.0}), {0.0, off_m, 0.0}};
  for (int i = 0; i < num_at_end; ++i) {
    const int query = 4 * kSide - 6 * i;
    join(6 * i, query,
         inverse(truth[static_cast<std::size_t>(6 * i)]) * off *
             truth[static_cast<std::size_t>(query)],
         true);
  }
  return lap;
}

// Accepted loops at the end. Expects that none of the random outliers is accepted.
int num_accepted_at_end(LongLap lap, const Config& config = {}) {
  const PoseGraphSummary summary = solve_pose_graph(lap.walk.graph, config);
  int count = 0;
  for (std::size_t i = 0; i < lap.walk.graph.edges.size(); ++i) {
    const bool is_accepted = lap.walk.graph.edges[i].is_loop && summary.weights[i] > 0.0;
    if (i >= lap.first_at_end) count += is_accepted;
    EXPECT_FALSE(is_accepted && i < lap.first_at_end) << i;
  }
  return count;
}

TEST(RobustPoseGraph, TwoConsistentLoopsAreAcceptedTogetherThoughEachAloneIsRejected) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    core::Random random(seed);
    const LongLap lap = long_lap(random, 2, 0.0);
    EXPECT_EQ(num_accepted_at_end(lap), 2) << seed;
    for (const std::size_t other : {lap.first_at_end, lap.first_at_end + 1}) {
      LongLap alone = lap;
      alone.walk.graph.edges.erase(alone.walk.graph.edges.begin() +
                                   static_cast<std::ptrdiff_t>(other));
      EXPECT_EQ(num_accepted_at_end(alone), 0) << seed;
    }
  }
}

TEST(RobustPoseGraph, WithoutGroupsConsistentLoopsAreRejected) {
  core::Random random(1);
  Config config;
  config.loop_groups.max_groups = 0;
  EXPECT_EQ(num_accepted_at_end(long_lap(random, 2, 0.0), config), 0);
}

TEST(RobustPoseGraph, AGroupOfConsistentLoopsIsOneHypothesis) {
  const auto num_accepted = [](double off_m) {
    core::Random random(1);
    return num_accepted_at_end(long_lap(random, 6, off_m));
  };
  EXPECT_GE(num_accepted(10.0), 5) << "within the drift of odometry";
  EXPECT_EQ(num_accepted(30.0), 0) << "each alone would be rejected, and so are six";
}

TEST(RobustPoseGraph, TheOnlyLoopIsAcceptedWithinTheDriftOfOdometry) {
  core::Random random(13);
  Laps walk = laps(random, 2);
  walk.graph.edges.resize(static_cast<std::size_t>(2 * kLapSteps));  // odometry and the first loop
  Laps wrong = walk;
  EXPECT_EQ(solve_pose_graph(walk.graph, {}).weights.back(), 1.0);
  wrong.graph.edges.back().a_from_b.translation.x() += 20.0;
  EXPECT_EQ(solve_pose_graph(wrong.graph, {}).weights.back(), 0.0);
}

}  // namespace
}  // namespace samewhere::optimize
