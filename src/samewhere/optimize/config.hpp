#pragma once

#include <samewhere/core/config.hpp>

namespace samewhere::optimize {

struct Config {
  int motion_rounds = 4;
  int motion_iterations = 8;
  int bundle_iterations = 8;
  int graph_iterations = 50;
  double loop_huber = 3.0;
};

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
  visit("loop_huber", config.loop_huber,
        {.help = "width of the Huber loss on loop edges, standard deviations",
         .min = 0.1,
         .max = 1000.0});
}

}  // namespace samewhere::optimize
