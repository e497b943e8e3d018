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
  int cull_unmatched_after_keyframes = 10;
  double min_found_ratio = 0.25;
  double redundant_ratio = 0.7;
  int visible_after_frames = 2;
  int loop_lag_keyframes = 1;
  int keyframes_in_memory = 200;
  double known_after_s = 120.0;
  int min_known_landmarks = 75;
};

// Keyframes of places that the map has known for long.
inline void visit_known_fields(Config& config, core::FieldVisitor& visit) {
  visit(
      "known_after_s", config.known_after_s,
      {.help = "a view of which most landmarks have been in the map for so long is no keyframe, s",
       .min = 0.0,
       .max = 1e9,
       .is_expert = true});
  visit("min_known_landmarks", config.min_known_landmarks,
        {.help = "least number of such landmarks", .min = 1, .max = 100000, .is_expert = true});
}

// Which views are kept.
inline void visit_keyframe_fields(Config& config, core::FieldVisitor& visit) {
  visit("min_landmarks", config.min_landmarks,
        {.help = "least features with depth of a keyframe", .min = 6, .max = 10000});
  visit("min_tracked_ratio", config.min_tracked_ratio,
        {.help = "new keyframe below this share of the reference keyframe's landmarks",
         .min = 0.0,
         .max = 1.0});
  visit("min_tracked", config.min_tracked,
        {.help = "new keyframe below this number of tracked landmarks", .min = 0, .max = 10000});
  visit("max_move_ratio", config.max_move_ratio,
        {.help = "new keyframe beyond this translation, share of the median depth",
         .min = 0.001,
         .max = 10.0});
  visit("max_turn_rad", config.max_turn_rad,
        {.help = "new keyframe beyond this rotation, radians", .min = 0.01, .max = 3.2});
  visit("min_tracked_ratio_without_depth", config.min_tracked_ratio_without_depth,
        {.help = "min_tracked_ratio without depth", .min = 0.0, .max = 1.0});
  visit("max_move_ratio_without_depth", config.max_move_ratio_without_depth,
        {.help = "max_move_ratio without depth", .min = 0.001, .max = 10.0});
}

// What is made of them.
inline void visit_landmark_fields(Config& config, core::FieldVisitor& visit) {
  visit(
      "max_neighbours", config.max_neighbours,
      {.help = "covisible keyframes of the local map beside the reference", .min = 0, .max = 100});
  visit("near_neighbours", config.near_neighbours,
        {.help = "the nearest of them: their landmarks are matched anywhere in the image if the "
                 "motion model fails",
         .min = 0,
         .max = 100});
  visit(
      "min_shared", config.min_shared,
      {.help = "least common landmarks of covisible keyframes in mapping", .min = 1, .max = 1000});
  visit("search_keyframes", config.search_keyframes,
        {.help = "covisible keyframes in which landmarks are triangulated and fused",
         .min = 0,
         .max = 100});
  visit("min_parallax_rad", config.min_parallax_rad,
        {.help = "least parallax of a triangulated landmark, radians", .min = 0.001, .max = 1.0});
  visit("fuse_radius_px", config.fuse_radius_px,
        {.help = "search radius for duplicate landmarks, pixels at full size",
         .min = 0.5,
         .max = 50.0});
}

// Full bundle adjustment after loops.
inline void visit_full_bundle_fields(Config& config, core::FieldVisitor& visit) {
  visit("full_bundle_observations", config.full_bundle_observations,
        {.help = "observations per keyframe in full bundle adjustment, about",
         .min = 20,
         .max = 10000});
  visit(
      "full_bundle_observations_without_depth", config.full_bundle_observations_without_depth,
      {.help =
           "full_bundle_observations without depth: landmarks with long tracks determine the scale",
       .min = 20,
       .max = 10000});
  visit("full_bundle_max_observations", config.full_bundle_max_observations,
        {.help = "larger maps have no full bundle adjustment; 0: off", .min = 0, .max = 10000000});
  visit("full_bundle_after_keyframes", config.full_bundle_after_keyframes,
        {.help = "keyframes after the last loop at which full bundle adjustment starts",
         .min = 0,
         .max = 10000});
  visit("full_bundle_pace", config.full_bundle_pace,
        {.help = "observations per keyframe of delay with which the result is applied",
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

// Local bundle adjustment and culling.
inline void visit_refinement_fields(Config& config, core::FieldVisitor& visit) {
  visit("bundle_keyframes", config.bundle_keyframes,
        {.help = "keyframes optimized by local bundle adjustment; 1: the new one only",
         .min = 1,
         .max = 100});
  visit("bundle_keyframes_without_depth", config.bundle_keyframes_without_depth,
        {.help = "bundle_keyframes without depth: a short window has scale drift",
         .min = 1,
         .max = 100});
  visit("bundle_fixed_keyframes", config.bundle_fixed_keyframes,
        {.help = "fixed keyframes of local bundle adjustment", .min = 1, .max = 200});
  visit("bundle_observations", config.bundle_observations,
        {.help = "largest number of observations in local bundle adjustment; landmarks with the "
                 "most observations first",
         .min = 100,
         .max = 1000000});
  visit("cull_after_keyframes", config.cull_after_keyframes,
        {.help = "keyframes after which a new landmark is tested by min_found_ratio",
         .min = 1,
         .max = 100});
  visit("cull_unmatched_after_keyframes", config.cull_unmatched_after_keyframes,
        {.help = "keyframes after which a landmark with one observation is culled",
         .min = 1,
         .max = 10000});
  visit("min_found_ratio", config.min_found_ratio,
        {.help = "landmarks observed by a smaller share of the keyframes that should observe them "
                 "are culled",
         .min = 0.0,
         .max = 1.0});
  visit("redundant_ratio", config.redundant_ratio,
        {.help = "keyframes whose landmarks are observed to a larger share by three others are "
                 "culled; 1: off (ORB-SLAM: 0.9)",
         .min = 0.1,
         .max = 1.0});
}

// When what mapping and loop closing found counts. With threads, more gives them more time beside
// tracking.
inline void visit_schedule_fields(Config& config, core::FieldVisitor& visit) {
  visit("visible_after_frames", config.visible_after_frames,
        {.help = "frames after which tracking uses a new keyframe; earlier if tracking needs it",
         .min = 1,
         .max = 1000});
  visit(
      "loop_lag_keyframes", config.loop_lag_keyframes,
      {.help = "keyframes after which the loops of a keyframe are applied", .min = 1, .max = 100});
  visit("keyframes_in_memory", config.keyframes_in_memory,
        {.help = "features of older keyframes, and landmarks unchanged for as long, are paged to "
                 "temporary files",
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
  visit_known_fields(config, visit);
}

}  // namespace samewhere::map
