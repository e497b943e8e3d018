#pragma once

#include <samewhere/core/config.hpp>

namespace samewhere::optimize {

// Loss of loop edges in a pose graph; see pose_graph.hpp.
enum class LoopLoss { kLeastSquares, kHuber, kDcs, kGnc, kGncEach };

// Rounds of graduated non-convexity (graduated_non_convexity.hpp). `limit` is the chi-square limit
// of a loop edge, Config::loop_chi2.
struct GncConfig {
  double growth = 1.4;
  int max_rounds = 100;
  int max_checks = 10;
  int num_retests = 3;
  double retest_ratio = 3000.0;
  double retest_step = 10.0;
  double max_suspended_ratio = 10.0;
  double max_support_ratio = 0.5;
};

inline void visit_iterations(GncConfig& config, core::FieldVisitor& visit) {
  visit("growth", config.growth,
        {.help = "factor of the control parameter per round (Yang et al., RA-L 2020: 1.4)",
         .min = 1.01,
         .max = 100.0,
         .is_expert = true});
  visit("max_rounds", config.max_rounds,
        {.help = "largest number of rounds", .min = 1, .max = 10000, .is_expert = true});
  visit(
      "max_checks", config.max_checks,
      {.help = "largest number of solutions until no loop edge changes between inlier and outlier",
       .min = 1,
       .max = 1000,
       .is_expert = true});
}

inline void visit_fields(GncConfig& config, core::FieldVisitor& visit) {
  visit_iterations(config, visit);
  visit("num_retests", config.num_retests,
        {.help = "times that rejected loop edges are re-tested, within shrinking limits",
         .min = 0,
         .max = 20,
         .is_expert = true});
  visit("retest_ratio", config.retest_ratio,
        {.help = "squared error up to which rejected loop edges are re-tested first, in loop_chi2",
         .min = 1.0,
         .max = 1e9,
         .is_expert = true});
  visit("retest_step", config.retest_step,
        {.help = "factor by which retest_ratio shrinks from one re-test to the next",
         .min = 1.01,
         .max = 1000.0,
         .is_expert = true});
  visit("max_suspended_ratio", config.max_suspended_ratio,
        {.help = "squared error up to which suspended loops are re-tested while all others fit, in "
                 "loop_chi2",
         .min = 1.0,
         .max = 1e6,
         .is_expert = true});
  visit("max_support_ratio", config.max_support_ratio,
        {.help = "a suspended loop supports a loop edge that lowers its squared error below this "
                 "share",
         .min = 0.0,
         .max = 1.0,
         .is_expert = true});
}

// Groups of rejected loop edges that are consistent with each other (consistent_loops.hpp).
struct LoopGroupConfig {
  int max_gap_nodes = 50;
  int max_groups = 20;
};

inline void visit_fields(LoopGroupConfig& config, core::FieldVisitor& visit) {
  visit("max_gap_nodes", config.max_gap_nodes,
        {.help = "largest distance of the ends of two consistent loop edges, nodes of odometry",
         .min = 0,
         .max = 100000,
         .is_expert = true});
  visit("max_groups", config.max_groups,
        {.help = "largest number of groups that are re-tested, the largest groups first",
         .min = 0,
         .max = 10000,
         .is_expert = true});
}

// Segments of loop edges that are rejected as one hypothesis (loop_segments.hpp).
struct LoopSegmentConfig {
  int max_segments = 4;
  int max_trials = 3;
  double min_gain = 3.0;
  double loop_cost = 0.03;
  int min_conflict_loops = 3;
  int max_conflict_gap = 3;
  int max_conflicts = 8;
};

inline void visit_fields(LoopSegmentConfig& config, core::FieldVisitor& visit) {
  visit("max_segments", config.max_segments,
        {.help = "largest number of rejected segments", .min = 0, .max = 100, .is_expert = true});
  visit("max_trials", config.max_trials,
        {.help = "candidate segments that are solved in full for each rejected one",
         .min = 1,
         .max = 100,
         .is_expert = true});
  visit("min_gain", config.min_gain,
        {.help = "least decrease of the robust cost for which a segment is rejected, in loop_chi2",
         .min = 0.0,
         .max = 1e6,
         .is_expert = true});
  visit(
      "loop_cost", config.loop_cost,
      {.help = "cost per accepted loop of a rejected segment, in loop_chi2: prefers short segments",
       .min = 0.0,
       .max = 1.0,
       .is_expert = true});
  visit("min_conflict_loops", config.min_conflict_loops,
        {.help = "least rejected loops in a row that bound a segment",
         .min = 1,
         .max = 1000,
         .is_expert = true});
  visit("max_conflict_gap", config.max_conflict_gap,
        {.help = "largest number of accepted loops between two rejected ones of a row",
         .min = 0,
         .max = 1000,
         .is_expert = true});
  visit("max_conflicts", config.max_conflicts,
        {.help = "largest number of such rows, the longest first",
         .min = 0,
         .max = 100,
         .is_expert = true});
}

// When measurement noise explains a solved graph (graph_consistency.hpp).
struct ConsistencyConfig {
  double max_sigmas = 5.0;
  double max_rejected_ratio = 0.02;
};

inline void visit_fields(ConsistencyConfig& config, core::FieldVisitor& visit) {
  visit("max_sigmas", config.max_sigmas,
        {.help = "largest excess of the sum of squared errors over its expectation, standard "
                 "deviations of chi-square",
         .min = 0.0,
         .max = 1000.0,
         .is_expert = true});
  visit(
      "max_rejected_ratio", config.max_rejected_ratio,
      {.help = "largest share of rejected loop edges", .min = 0.0, .max = 1.0, .is_expert = true});
}

// A graph file solved from several initial guesses (initial_guesses.hpp).
struct GuessConfig {
  int large_graph_nodes = 2000;
  int final_factor = 4;
};

inline void visit_fields(GuessConfig& config, core::FieldVisitor& visit) {
  visit("large_graph_nodes", config.large_graph_nodes,
        {.help = "with more poses the first solution with most loop edges accepted is taken",
         .min = 0,
         .max = 100000000,
         .is_expert = true});
  visit("final_factor", config.final_factor,
        {.help = "iterations of the last solution at most, in graph_iterations",
         .min = 1,
         .max = 1000,
         .is_expert = true});
}

struct Config {
  int motion_rounds = 4;
  int motion_iterations = 8;
  int motion_min_inliers = 6;
  int bundle_iterations = 8;
  int bundle_min_observations = 12;
  int graph_iterations = 50;
  LoopLoss loop_loss = LoopLoss::kGnc;
  double loop_chi2 = 16.81;
  double loop_huber = 3.0;
  double loop_dcs = 1.0;
  int gnc_iterations = 3;
  double odometry_scale_sigma = 0.01;
  double loop_scale_sigma = 0.05;
  GncConfig gnc = {};
  LoopGroupConfig loop_groups = {};
  LoopSegmentConfig loop_segments = {};
  ConsistencyConfig consistency = {};
  GuessConfig initial_guesses = {};
};

// Scale of a camera without depth.
inline void visit_scale_fields(Config& config, core::FieldVisitor& visit) {
  visit("odometry_scale_sigma", config.odometry_scale_sigma,
        {.help = "without depth: standard deviation of the scale drift from one keyframe to the "
                 "next, as a share",
         .min = 1e-6,
         .max = 1.0});
  visit("loop_scale_sigma", config.loop_scale_sigma,
        {.help = "without depth: standard deviation of the scale between both ends of a loop edge, "
                 "as a share",
         .min = 1e-6,
         .max = 1.0});
}

// Motion-only optimization and bundle adjustment.
inline void visit_reprojection_fields(Config& config, core::FieldVisitor& visit) {
  visit("motion_rounds", config.motion_rounds,
        {.help = "rounds of motion-only optimization, each ends with a classification of inliers",
         .min = 1,
         .max = 20});
  visit("motion_iterations", config.motion_iterations,
        {.help = "Gauss-Newton steps per round", .min = 1, .max = 100});
  visit("motion_min_inliers", config.motion_min_inliers,
        {.help = "least inliers of motion-only optimization; with fewer the pose stays",
         .min = 3,
         .max = 1000,
         .is_expert = true});
  visit("bundle_iterations", config.bundle_iterations,
        {.help = "largest number of iterations of each of the two rounds of bundle adjustment",
         .min = 1,
         .max = 200});
  visit("bundle_min_observations", config.bundle_min_observations,
        {.help = "least inliers of a free keyframe in bundle adjustment; with fewer its pose stays",
         .min = 1,
         .max = 1000,
         .is_expert = true});
}

// Loss of loop edges.
inline void visit_loss_fields(Config& config, core::FieldVisitor& visit) {
  visit("loop_loss", config.loop_loss,
        {.help = "loss of loop edges: least_squares, huber, dcs (dynamic covariance scaling, "
                 "Agarwal et al., ICRA 2013), gnc (graduated non-convexity with checks of segments "
                 "and groups), gnc_each (as published by Yang et al., RA-L 2020)",
         .choices = {"least_squares", "huber", "dcs", "gnc", "gnc_each"}});
  visit("loop_chi2", config.loop_chi2,
        {.help = "largest squared error of an accepted loop edge, in variances (16.81: 99 % of "
                 "chi-square with 6 degrees of freedom)",
         .min = 1.0,
         .max = 1e6});
  visit("loop_huber", config.loop_huber,
        {.help = "width of the Huber loss on loop edges, standard deviations",
         .min = 0.1,
         .max = 1000.0});
  visit("loop_dcs", config.loop_dcs,
        {.help = "squared error up to which dynamic covariance scaling weighs a loop edge in full, "
                 "in variances",
         .min = 0.01,
         .max = 1e6});
  visit("gnc_iterations", config.gnc_iterations,
        {.help = "iterations of the graph per round of graduated non-convexity",
         .min = 1,
         .max = 100});
}

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit_reprojection_fields(config, visit);
  visit("graph_iterations", config.graph_iterations,
        {.help = "largest number of iterations of the pose graph", .min = 1, .max = 1000});
  visit_loss_fields(config, visit);
  visit_scale_fields(config, visit);
  visit("gnc", config.gnc, {.help = "Graduated non-convexity over loop edges", .is_expert = true});
  visit("loop_groups", config.loop_groups,
        {.help = "Groups of consistent loop edges, re-tested together", .is_expert = true});
  visit("loop_segments", config.loop_segments,
        {.help = "Segments of loop edges, rejected as one hypothesis", .is_expert = true});
  visit("consistency", config.consistency,
        {.help = "When measurement noise explains a solved graph", .is_expert = true});
  visit("initial_guesses", config.initial_guesses,
        {.help = "Of `samewhere optimize`: solution from several initial guesses",
         .is_expert = true});
}

}  // namespace samewhere::optimize
