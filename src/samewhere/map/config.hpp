#pragma once

#include <samewhere/core/config.hpp>

namespace samewhere::map {

struct Config {
  int min_landmarks = 50;
  double min_tracked_ratio = 0.6;
  double max_move_ratio = 0.15;
  double max_turn_rad = 0.26;
  int max_neighbours = 6;
};

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit(
      "min_landmarks", config.min_landmarks,
      {.help = "a view with fewer features of known depth is no keyframe", .min = 6, .max = 10000});
  visit("min_tracked_ratio", config.min_tracked_ratio,
        {.help =
             "new keyframe when the view shows fewer landmarks than this share of the reference's",
         .min = 0.0,
         .max = 1.0});
  visit("max_move_ratio", config.max_move_ratio,
        {.help = "new keyframe after moving this share of the median depth",
         .min = 0.001,
         .max = 10.0});
  visit("max_turn_rad", config.max_turn_rad,
        {.help = "new keyframe after turning by this, radians", .min = 0.01, .max = 3.2});
  visit("max_neighbours", config.max_neighbours,
        {.help = "keyframes beside the reference whose landmarks tracking sees",
         .min = 0,
         .max = 100});
}

}  // namespace samewhere::map
