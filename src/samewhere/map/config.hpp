#pragma once

#include <samewhere/core/config.hpp>

namespace samewhere::map {

struct Config {
  int min_landmarks = 50;
  double min_tracked_ratio = 0.6;
  int min_tracked = 150;
  double max_move_ratio = 0.15;
  double max_turn_rad = 0.15;
  double min_tracked_ratio_without_depth = 0.5;
  double max_move_ratio_without_depth = 0.1;
  int max_neighbours = 20;
  int near_neighbours = 6;
  int min_shared = 15;
  int search_keyframes = 8;
  double min_parallax_rad = 0.018;
  double fuse_radius_px = 3.0;
  int bundle_keyframes = 8;
  int bundle_keyframes_without_depth = 20;
  int bundle_fixed_keyframes = 16;
  int bundle_observations = 8000;
  int full_bundle_observations = 400;
  int full_bundle_observations_without_depth = 100;
  int full_bundle_max_observations = 300000;
  int full_bundle_min_observations = 20;
  int full_bundle_after_keyframes = 5;
  int full_bundle_pace = 4000;
  int cull_after_keyframes = 3;
  int forget_after_keyframes = 10;
  double min_found_ratio = 0.25;
  double redundant_ratio = 0.7;
  int visible_after_frames = 2;
  int loop_lag_keyframes = 1;
  int keyframes_in_memory = 200;
};

// Which views are kept.
inline void visit_keyframe_fields(Config& config, core::FieldVisitor& visit) {
  visit(
      "min_landmarks", config.min_landmarks,
      {.help = "a view with fewer features of known depth is no keyframe", .min = 6, .max = 10000});
  visit("min_tracked_ratio", config.min_tracked_ratio,
        {.help =
             "new keyframe when the view shows fewer landmarks than this share of the reference's",
         .min = 0.0,
         .max = 1.0});
  visit("min_tracked", config.min_tracked,
        {.help = "new keyframe when the view shows fewer landmarks than this",
         .min = 0,
         .max = 10000});
  visit("max_move_ratio", config.max_move_ratio,
        {.help = "new keyframe after moving this share of the median depth",
         .min = 0.001,
         .max = 10.0});
  visit("max_turn_rad", config.max_turn_rad,
        {.help = "new keyframe after turning by this, radians", .min = 0.01, .max = 3.2});
  visit(
      "min_tracked_ratio_without_depth", config.min_tracked_ratio_without_depth,
      {.help = "min_tracked_ratio of a map whose depths come from motion", .min = 0.0, .max = 1.0});
  visit(
      "max_move_ratio_without_depth", config.max_move_ratio_without_depth,
      {.help = "max_move_ratio of a map whose depths come from motion", .min = 0.001, .max = 10.0});
}

// What is made of them.
inline void visit_landmark_fields(Config& config, core::FieldVisitor& visit) {
  visit("max_neighbours", config.max_neighbours,
        {.help = "keyframes beside the reference whose landmarks tracking sees",
         .min = 0,
         .max = 100});
  visit("near_neighbours", config.near_neighbours,
        {.help = "the nearest of them, whose landmarks are looked for all over the view when the "
                 "motion is lost",
         .min = 0,
         .max = 100});
  visit("min_shared", config.min_shared,
        {.help = "keyframes that share fewer landmarks are no neighbours to mapping",
         .min = 1,
         .max = 1000});
  visit("search_keyframes", config.search_keyframes,
        {.help = "neighbours in which a new keyframe looks for the points it sees",
         .min = 0,
         .max = 100});
  visit("min_parallax_rad", config.min_parallax_rad,
        {.help = "angle between two rays from which a point is made, radians",
         .min = 0.001,
         .max = 1.0});
  visit("fuse_radius_px", config.fuse_radius_px,
        {.help = "two landmarks closer together in a picture may be one, pixels at full size",
         .min = 0.5,
         .max = 50.0});
}

// How all of the map is bettered when a loop has moved it.
inline void visit_full_bundle_fields(Config& config, core::FieldVisitor& visit) {
  visit("full_bundle_observations", config.full_bundle_observations,
        {.help = "observations of each keyframe in a bundle of the whole map, about",
         .min = 20,
         .max = 10000});
  visit(
      "full_bundle_observations_without_depth", config.full_bundle_observations_without_depth,
      {.help = "full_bundle_observations of a map whose depths come from motion: only what is seen "
               "long tells lengths",
       .min = 20,
       .max = 10000});
  visit("full_bundle_max_observations", config.full_bundle_max_observations,
        {.help = "a map that would have more is not bundled as a whole; 0: none is",
         .min = 0,
         .max = 10000000});
  visit("full_bundle_after_keyframes", config.full_bundle_after_keyframes,
        {.help = "keyframes after the last loop until the whole map is bundled",
         .min = 0,
         .max = 10000});
  visit("full_bundle_pace", config.full_bundle_pace,
        {.help = "the result counts one keyframe later for each so many observations",
         .min = 1,
         .max = 10000000});
}

// Which keyframes full bundle adjustment leaves out.
inline void visit_full_bundle_window_fields(Config& config, core::FieldVisitor& visit) {
  visit("full_bundle_min_observations", config.full_bundle_min_observations,
        {.help = "least observations of a keyframe in full bundle adjustment",
         .min = 1,
         .max = 10000,
         .is_expert = true});
}

// How both are bettered, and which go again.
inline void visit_refinement_fields(Config& config, core::FieldVisitor& visit) {
  visit("bundle_keyframes", config.bundle_keyframes,
        {.help = "keyframes that a local bundle moves; 1 moves only the new one",
         .min = 1,
         .max = 100});
  visit(
      "bundle_keyframes_without_depth", config.bundle_keyframes_without_depth,
      {.help = "bundle_keyframes of a map whose depths come from motion: a short window loses the "
               "scale",
       .min = 1,
       .max = 100});
  visit("bundle_fixed_keyframes", config.bundle_fixed_keyframes,
        {.help = "keyframes beside them that hold a local bundle in place", .min = 1, .max = 200});
  visit("bundle_observations", config.bundle_observations,
        {.help = "observations in a local bundle at most; landmarks seen most often come first",
         .min = 100,
         .max = 1000000});
  visit("cull_after_keyframes", config.cull_after_keyframes,
        {.help = "keyframes after which a new landmark must have proved itself",
         .min = 1,
         .max = 100});
  visit("forget_after_keyframes", config.forget_after_keyframes,
        {.help = "keyframes after which a landmark goes that no second one saw",
         .min = 1,
         .max = 10000});
  visit("min_found_ratio", config.min_found_ratio,
        {.help = "a landmark goes if fewer of the keyframes that should see it do",
         .min = 0.0,
         .max = 1.0});
  visit("redundant_ratio", config.redundant_ratio,
        {.help = "a keyframe goes if three others see more than this share of its landmarks as "
                 "well; 1: none goes",
         .min = 0.1,
         .max = 1.0});
}

// When what mapping and loop closing found counts. With threads, more gives them more time beside
// tracking.
inline void visit_schedule_fields(Config& config, core::FieldVisitor& visit) {
  visit("visible_after_frames", config.visible_after_frames,
        {.help = "a keyframe shows in the map that tracking sees this many frames later; sooner if "
                 "tracking is in trouble",
         .min = 1,
         .max = 1000});
  visit("loop_lag_keyframes", config.loop_lag_keyframes,
        {.help = "the loops of a keyframe correct the map before the keyframe this much later is "
                 "added",
         .min = 1,
         .max = 100});
  visit("keyframes_in_memory", config.keyframes_in_memory,
        {.help =
             "the features of older ones, and landmarks that as many did not change, lie in files "
             "without a name and come back when needed",
         .min = 1,
         .max = 1000000});
}

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit_keyframe_fields(config, visit);
  visit_landmark_fields(config, visit);
  visit_refinement_fields(config, visit);
  visit_full_bundle_fields(config, visit);
  visit_full_bundle_window_fields(config, visit);
  visit_schedule_fields(config, visit);
}

}  // namespace samewhere::map
