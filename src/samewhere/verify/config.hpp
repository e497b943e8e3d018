#pragma once

#include <samewhere/core/config.hpp>

namespace samewhere::verify {

// What makes a candidate the best of its query.
enum class RankBy { kSimilarity, kInliers };

// Whether places of this building may look alike. kRepetitive: appearance alone accepts nothing.
// kUnique: the user states that there are none, and appearance with geometry accepts.
enum class Prior { kRepetitive, kUnique };

// What decides on a candidate with a relative pose. kEvidence: odometry gate, competing hypotheses
// and prior. kDeformation: how much the pose graph bends, after ROVER (Yu et al., arXiv
// 2508.13488): a baseline to compare with.
enum class Method { kEvidence, kDeformation };

struct Config {
  Prior prior = Prior::kRepetitive;
  Method method = Method::kEvidence;
  double max_deformation_ratio = 0.02;
  double min_look_alike_distance_m = 3.0;
  double min_look_alike_distance_without_depth = 1.0;
  double min_look_alike_gain = 12.0;
  double min_variance_factor = 0.25;
  double min_similarity = -1.0;
  int pause_frames = 0;
  bool require_geometry = true;
  RankBy rank_by = RankBy::kInliers;
  int min_matches = 20;
  int min_inliers = 40;
  double min_spread_ratio = 0.12;
  bool require_pose = true;
  double max_pose_difference_m = 0.15;
  double max_pose_difference_rad = 0.05;
  double max_error_px = 4.0;
  double refine_radius_px = 6.0;
  int ransac_iterations = 500;
  int min_views = 10;
  int min_inliers_in_sequence = 20;
  int max_view_gap = 3;
  int max_pending_views = 20;
  double same_view_ratio = 0.15;
  int neighbour_frames = 0;
  double max_odometry_chi_square = 16.81;
  double max_competing_chi_square = 30.0;
  double min_competing_gain = 6.0;
  double max_competing_place_ratio = 0.75;
  double loop_sigma_m = 0.03;
  double loop_sigma_rad = 0.01;
  int asked_again_per_keyframe = 8;
  bool measure_all = false;
};

inline void visit_evidence(Config& config, core::FieldVisitor& visit) {
  visit("prior", config.prior,
        {.help = "repetitive: places may look alike, appearance alone accepts nothing; unique: no "
                 "two places look alike",
         .choices = {"repetitive", "unique"}});
  visit("method", config.method,
        {.help = "evidence: odometry gate, competing hypotheses and prior decide; deformation: how "
                 "much the pose graph bends (baseline, after ROVER)",
         .choices = {"evidence", "deformation"}});
  visit("max_deformation_ratio", config.max_deformation_ratio,
        {.help = "method deformation: largest displacement of the keyframes between match and "
                 "query, root mean square, over the length of the trajectory there",
         .min = 0.0,
         .max = 10.0,
         .is_expert = true});
  visit("min_look_alike_distance_m", config.min_look_alike_distance_m,
        {.help = "prior repetitive: least distance of two look-alike places, metres; odometry must "
                 "tell the loop's place from one so far away",
         .min = 0.01,
         .max = 1000.0});
  visit("min_look_alike_distance_without_depth", config.min_look_alike_distance_without_depth,
        {.help = "the same without depth, in median landmark depths at initialization",
         .min = 0.01,
         .max = 1000.0});
  visit(
      "min_look_alike_gain", config.min_look_alike_gain,
      {.help = "prior repetitive: least log-likelihood ratio, times two, of the loop's place over "
               "a look-alike place under odometry",
       .min = 0.0,
       .max = 1e9});
}

inline void visit_drift(Config& config, core::FieldVisitor& visit) {
  visit("min_variance_factor", config.min_variance_factor,
        {.help = "closed loops show how much smaller the errors of odometry are than its "
                 "covariances; these are multiplied by as little as this; 1: not at all",
         .min = 0.01,
         .max = 1.0});
}

inline void visit_thresholds(Config& config, core::FieldVisitor& visit) {
  visit("min_similarity", config.min_similarity,
        {.help = "least similarity of the descriptors (NCC)", .min = -1.0, .max = 1.0});
  visit("pause_frames", config.pause_frames,
        {.help = "frames after a loop without another, nor a second loop of the same view "
                 "(published method); 0: off",
         .min = 0,
         .max = 100000});
  visit("require_geometry", config.require_geometry,
        {.help = "false: similarity alone decides, as published"});
  visit("rank_by", config.rank_by,
        {.help = "order of the candidates of one view", .choices = {"similarity", "inliers"}});
  visit("min_matches", config.min_matches,
        {.help = "least feature matches", .min = 7, .max = 100000});
  visit("min_inliers", config.min_inliers,
        {.help = "least geometric inliers; in `loops` of a view alone, without a sequence",
         .min = 7,
         .max = 100000});
  visit("min_spread_ratio", config.min_spread_ratio,
        {.help = "least share of the 8 x 8 image cells with inliers", .min = 0.0, .max = 1.0});
  visit("require_pose", config.require_pose,
        {.help =
             "candidates without a relative pose are rejected; off in `loops` and relocalization"});
  visit("max_pose_difference_m", config.max_pose_difference_m,
        {.help = "pose consistency: largest translation between the poses from the query's and "
                 "from the match's depth, metres",
         .min = 0.001,
         .max = 100.0});
  visit("max_pose_difference_rad", config.max_pose_difference_rad,
        {.help = "the same for the rotation, radians", .min = 0.001, .max = 3.2});
}

inline void visit_sequence(Config& config, core::FieldVisitor& visit) {
  visit("min_views", config.min_views,
        {.help = "`loops`: consecutive views that must match where one has fewer than min_inliers "
                 "(sequence verification); 1: off",
         .min = 1,
         .max = 1000});
  visit("min_inliers_in_sequence", config.min_inliers_in_sequence,
        {.help = "`loops`: least geometric inliers of each of them", .min = 7, .max = 100000});
  visit("max_view_gap", config.max_view_gap,
        {.help = "`loops`: largest gap in a sequence, views", .min = 1, .max = 100});
  visit("max_pending_views", config.max_pending_views,
        {.help = "`loops`: views after which a pending candidate is rejected",
         .min = 1,
         .max = 1000});
  visit(
      "same_view_ratio", config.same_view_ratio,
      {.help = "`loops`: a frame with this share of the last view's features is part of that view",
       .min = 0.0,
       .max = 1.0});
  visit("neighbour_frames", config.neighbour_frames,
        {.help = "`loops`: largest offset in frames at which neighbours of the best match are "
                 "verified, then half of it and so on; 0: off",
         .min = 0,
         .max = 1000});
}

inline void visit_measurement(Config& config, core::FieldVisitor& visit) {
  visit("max_error_px", config.max_error_px,
        {.help = "largest reprojection error of a RANSAC inlier, pixels", .min = 0.1, .max = 50.0});
  visit("refine_radius_px", config.refine_radius_px,
        {.help = "search radius of the guided second matching, pixels", .min = 0.5, .max = 100.0});
  visit("ransac_iterations", config.ransac_iterations,
        {.help = "largest number of RANSAC samples", .min = 1, .max = 100000});
  visit("max_odometry_chi_square", config.max_odometry_chi_square,
        {.help = "odometry gate: largest squared Mahalanobis distance of the loop's correction, 6 "
                 "degrees of freedom; 16.81: 99 %",
         .min = 1.0,
         .max = 1e9});
  visit("max_competing_chi_square", config.max_competing_chi_square,
        {.help = "competing hypothesis: the same from the pose after the last loop, with the drift "
                 "since then",
         .min = 1.0,
         .max = 1e9});
  visit("min_competing_gain", config.min_competing_gain,
        {.help = "competing hypothesis: least gain in log-likelihood, times two, over the loops "
                 "that it contradicts",
         .min = 0.0,
         .max = 1e9});
  visit("max_competing_place_ratio", config.max_competing_place_ratio,
        {.help = "ambiguous if another place of the same view passes all checks with more than "
                 "this share of the inliers",
         .min = 0.0,
         .max = 1e9});
  visit("loop_sigma_m", config.loop_sigma_m,
        {.help = "standard deviation of a loop's translation, metres", .min = 1e-4, .max = 10.0});
  visit("loop_sigma_rad", config.loop_sigma_rad,
        {.help = "standard deviation of a loop's rotation, radians", .min = 1e-4, .max = 3.0});
  visit("asked_again_per_keyframe", config.asked_again_per_keyframe,
        {.help = "ambiguous candidates of earlier keyframes that are decided again with each "
                 "keyframe, after the loops of the map have changed; 0: none",
         .min = 0,
         .max = 1000});
  visit("measure_all", config.measure_all,
        {.help = "geometry is measured for all candidates, also of those rejected by similarity or "
                 "pause: for `ledger RUN replay`"});
}

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit_evidence(config, visit);
  visit_drift(config, visit);
  visit_thresholds(config, visit);
  visit_sequence(config, visit);
  visit_measurement(config, visit);
}

}  // namespace samewhere::verify
