#pragma once

#include <samewhere/core/config.hpp>

namespace samewhere::verify {

// What makes a candidate the best of its query.
enum class RankBy { kSimilarity, kInliers };

struct Config {
  double min_similarity = -1.0;
  int pause_frames = 0;
  bool require_geometry = true;
  RankBy rank_by = RankBy::kInliers;
  int min_matches = 20;
  int min_inliers = 40;
  double min_spread_ratio = 0.12;
  bool require_pose = true;
  double max_disagreement_m = 0.15;
  double max_disagreement_rad = 0.05;
  double max_error_px = 4.0;
  double refine_radius_px = 6.0;
  int ransac_iterations = 500;
  int min_views = 10;
  int min_inliers_in_sequence = 20;
  int max_view_gap = 3;
  int wait_views = 20;
  double same_view_ratio = 0.15;
  int look_around_frames = 0;
  double max_odometry_chi_square = 16.81;
  double max_rival_chi_square = 30.0;
  double min_rival_gain = 6.0;
  double max_other_place_ratio = 0.75;
  double loop_sigma_m = 0.03;
  double loop_sigma_rad = 0.01;
  bool measure_all = false;
};

inline void visit_thresholds(Config& config, core::FieldVisitor& visit) {
  visit("min_similarity", config.min_similarity,
        {.help = "descriptors less similar (NCC) are refused", .min = -1.0, .max = 1.0});
  visit("pause_frames", config.pause_frames,
        {.help = "frames after a loop in which no other is accepted, nor is a second one of the "
                 "loop's own view (paper, section on the interval); 0: no limit",
         .min = 0,
         .max = 100000});
  visit("require_geometry", config.require_geometry,
        {.help = "false: similarity alone decides, as in the paper"});
  visit("rank_by", config.rank_by,
        {.help = "what makes a candidate the best of its query",
         .choices = {"similarity", "inliers"}});
  visit("min_matches", config.min_matches,
        {.help = "fewer feature matches are refused", .min = 7, .max = 100000});
  visit("min_inliers", config.min_inliers,
        {.help = "fewer geometric inliers are refused", .min = 7, .max = 100000});
  visit("min_spread_ratio", config.min_spread_ratio,
        {.help = "share of the picture's 8 x 8 cells that inliers must cover",
         .min = 0.0,
         .max = 1.0});
  visit(
      "require_pose", config.require_pose,
      {.help = "candidates without a relative pose are refused: nothing but their looks speaks for "
               "them; recognition alone (`loops`) and who is lost do not ask"});
  visit("max_disagreement_m", config.max_disagreement_m,
        {.help =
             "the pose from the query's depth and that from the match's may differ by this, metres",
         .min = 0.001,
         .max = 100.0});
  visit("max_disagreement_rad", config.max_disagreement_rad,
        {.help = "the same, radians", .min = 0.001, .max = 3.2});
}

inline void visit_sequence(Config& config, core::FieldVisitor& visit) {
  visit("min_views", config.min_views,
        {.help = "recognition alone, where no map and no path travelled can tell: as many views in "
                 "a row must go on to match; 1: each view speaks for itself",
         .min = 1,
         .max = 1000});
  visit("min_inliers_in_sequence", config.min_inliers_in_sequence,
        {.help = "each of them with so many geometric inliers", .min = 7, .max = 100000});
  visit("max_view_gap", config.max_view_gap,
        {.help = "a sequence goes on over so many views", .min = 1, .max = 100});
  visit("wait_views", config.wait_views,
        {.help = "views after which who still waits is refused", .min = 1, .max = 1000});
  visit(
      "same_view_ratio", config.same_view_ratio,
      {.help = "a frame that shares so many of its features with the last view is still that view",
       .min = 0.0,
       .max = 1.0});
  visit("look_around_frames", config.look_around_frames,
        {.help = "frames so far beside the best match, then half as far and so on, are asked "
                 "whether they show more of the same; 0: what search finds is all",
         .min = 0,
         .max = 1000});
}

inline void visit_measurement(Config& config, core::FieldVisitor& visit) {
  visit("max_error_px", config.max_error_px,
        {.help = "reprojection error of a RANSAC inlier", .min = 0.1, .max = 50.0});
  visit("refine_radius_px", config.refine_radius_px,
        {.help = "search radius of the second look, around the projection",
         .min = 0.5,
         .max = 100.0});
  visit("ransac_iterations", config.ransac_iterations,
        {.help = "RANSAC samples at most", .min = 1, .max = 100000});
  visit("max_odometry_chi_square", config.max_odometry_chi_square,
        {.help = "squared Mahalanobis distance of the correction under the drift model, 6 degrees "
                 "of freedom",
         .min = 1.0,
         .max = 1e9});
  visit("max_rival_chi_square", config.max_rival_chi_square,
        {.help = "the same from where the last loop has put the camera, under the drift since then "
                 "alone: beyond, two places explain the view",
         .min = 1.0,
         .max = 1e9});
  visit("min_rival_gain", config.min_rival_gain,
        {.help = "such a candidate is a loop all the same, and those before that contradict it are "
                 "none, if odometry makes it so much likelier than them: twice the logarithm of "
                 "the ratio",
         .min = 0.0,
         .max = 1e9});
  visit(
      "max_other_place_ratio", config.max_other_place_ratio,
      {.help = "a candidate is ambiguous if another one of the same view has more than so many of "
               "its inliers, passes all checks, and shows what the map knows to be another place",
       .min = 0.0,
       .max = 1e9});
  visit("loop_sigma_m", config.loop_sigma_m,
        {.help = "standard deviation of a loop's translation, metres", .min = 1e-4, .max = 10.0});
  visit("loop_sigma_rad", config.loop_sigma_rad,
        {.help = "standard deviation of a loop's rotation, radians", .min = 1e-4, .max = 3.0});
  visit(
      "measure_all", config.measure_all,
      {.help = "geometry is measured of candidates, too, that looks or the pause have refused: for "
               "`ledger RUN replay`"});
}

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit_thresholds(config, visit);
  visit_sequence(config, visit);
  visit_measurement(config, visit);
}

}  // namespace samewhere::verify
