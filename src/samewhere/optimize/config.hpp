#pragma once

#include <samewhere/core/config.hpp>

namespace samewhere::optimize {

// How loop edges that lie are kept from bending the graph; see pose_graph.hpp.
enum class LoopLoss { kLeastSquares, kHuber, kDcs, kGnc, kGncEach };

struct Config {
  int motion_rounds = 4;
  int motion_iterations = 8;
  int bundle_iterations = 8;
  int graph_iterations = 50;
  LoopLoss loop_loss = LoopLoss::kGnc;
  double loop_chi2 = 16.81;
  double loop_huber = 3.0;
  double loop_dcs = 1.0;
  int gnc_iterations = 3;
  double odometry_scale_sigma = 0.01;
  double loop_scale_sigma = 0.05;
};

// Of a camera without depth.
inline void visit_scale_fields(Config& config, core::FieldVisitor& visit) {
  visit(
      "odometry_scale_sigma", config.odometry_scale_sigma,
      {.help =
           "of a camera without depth, how far its scale creeps at random from one keyframe to the "
           "next, as a share",
       .min = 1e-6,
       .max = 1.0});
  visit("loop_scale_sigma", config.loop_scale_sigma,
        {.help = "of a camera without depth, error of the scale between both ends of a loop, as a "
                 "share",
         .min = 1e-6,
         .max = 1.0});
}

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit("motion_rounds", config.motion_rounds,
        {.help = "times that motion-only optimisation sorts inliers from outliers anew",
         .min = 1,
         .max = 20});
  visit("motion_iterations", config.motion_iterations,
        {.help = "Gauss-Newton steps per round", .min = 1, .max = 100});
  visit("bundle_iterations", config.bundle_iterations,
        {.help = "iterations of each of the two rounds of a bundle at most", .min = 1, .max = 200});
  visit("graph_iterations", config.graph_iterations,
        {.help = "iterations of the pose graph at most", .min = 1, .max = 1000});
  visit(
      "loop_loss", config.loop_loss,
      {.help = "what a loop edge may do to the graph: least_squares all, huber and dcs (dynamic "
               "covariance scaling) the less the worse it fits, gnc (graduated non-convexity) all "
               "or nothing, a stretch of loops as one claim; gnc_each the same as published, each "
               "loop for itself",
       .choices = {"least_squares", "huber", "dcs", "gnc", "gnc_each"}});
  visit(
      "loop_chi2", config.loop_chi2,
      {.help = "squared error of a loop edge, in variances, beyond which it is refused; 16.81: one "
               "right one of a hundred",
       .min = 1.0,
       .max = 1e6});
  visit("loop_huber", config.loop_huber,
        {.help = "width of the Huber loss on loop edges, standard deviations",
         .min = 0.1,
         .max = 1000.0});
  visit(
      "loop_dcs", config.loop_dcs,
      {.help = "squared error, in variances, up to which dynamic covariance scaling trusts a loop "
               "edge in full",
       .min = 0.01,
       .max = 1e6});
  visit("gnc_iterations", config.gnc_iterations,
        {.help = "iterations of the graph per round of graduated non-convexity",
         .min = 1,
         .max = 100});
  visit_scale_fields(config, visit);
}

}  // namespace samewhere::optimize
