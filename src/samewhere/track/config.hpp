#pragma once

#include <samewhere/core/config.hpp>

namespace samewhere::track {

// How sure odometry may be of where a frame is relative to its reference keyframe.
struct DriftConfig {
  double factor = 2.0;
  double factor_without_depth = 3.0;
  double per_metre = 0.01;
  double per_radian = 0.01;
  double weak_factor = 3.0;
};

inline void visit_fields(DriftConfig& config, core::FieldVisitor& visit) {
  visit("factor", config.factor,
        {.help = "errors of odometry are this many times what the residuals of a frame leave open",
         .min = 0.01,
         .max = 100.0});
  visit("factor_without_depth", config.factor_without_depth,
        {.help = "the same of a camera without depth, whose local map is known less well",
         .min = 0.01,
         .max = 100.0});
  visit("per_metre", config.per_metre,
        {.help = "error per metre moved, of a camera that is calibrated as well as most, metres",
         .min = 0.0,
         .max = 1.0});
  visit("per_radian", config.per_radian,
        {.help = "the same per radian turned, radians", .min = 0.0, .max = 1.0});
  visit("weak_factor", config.weak_factor,
        {.help = "all errors times this while tracking is weak", .min = 1.0, .max = 100.0});
}

// What relates two views (two_view_model.hpp).
enum class StartModel { kHomographyOrEssential, kFundamental };

// How a camera without depth starts, from two views.
struct StartConfig {
  StartModel model = StartModel::kHomographyOrEssential;
  int min_matches = 100;
  int min_points = 60;
  double max_error_px = 2.0;
  int ransac_iterations = 200;
  double min_homography_ratio = 0.45;
  double min_parallax_rad = 0.02;
  double min_point_parallax_rad = 0.01;
  double max_rival_ratio = 0.7;
  int max_waiting_frames = 300;
  int provisional_keyframes = 20;
  double provisional_s = 5.0;
};

// When a start is given up.
inline void visit_giving_up(StartConfig& config, core::FieldVisitor& visit) {
  visit("max_waiting_frames", config.max_waiting_frames,
        {.help = "frames after which a first view without a start gives up its place",
         .min = 1,
         .max = 100000});
  visit("provisional_keyframes", config.provisional_keyframes,
        {.help = "a map that is lost before it has so many keyframes is given up for a new start",
         .min = 0,
         .max = 10000});
  visit("provisional_s", config.provisional_s,
        {.help = "with depth also one that was followed for less, seconds, and is lost for longer: "
                 "in a crowd every frame is a keyframe",
         .min = 0.0,
         .max = 3600.0});
}

inline void visit_fields(StartConfig& config, core::FieldVisitor& visit) {
  visit("model", config.model,
        {.help = "of the two views, from which R and t are taken: the better of homography and "
                 "essential matrix, or the fundamental matrix, eq. (18)-(22)",
         .choices = {"homography_or_essential", "fundamental"}});
  visit(
      "min_matches", config.min_matches,
      {.help = "fewer matches of the two views are no start, and the later view becomes the first",
       .min = 8,
       .max = 10000});
  visit("min_points", config.min_points,
        {.help = "fewer points in front of both views are no start", .min = 8, .max = 10000});
  visit("max_error_px", config.max_error_px,
        {.help = "error of a match that agrees with a motion", .min = 0.1, .max = 50.0});
  visit("ransac_iterations", config.ransac_iterations,
        {.help = "RANSAC samples of either model at most", .min = 1, .max = 100000});
  visit("min_homography_ratio", config.min_homography_ratio,
        {.help =
             "share of the homography in the scores of both models from which it is chosen, or the "
             "fundamental matrix refused",
         .min = 0.0,
         .max = 1.0});
  visit("min_parallax_rad", config.min_parallax_rad,
        {.help = "median parallax of a start, radians; less is a rotation",
         .min = 0.001,
         .max = 1.0});
  visit("min_point_parallax_rad", config.min_point_parallax_rad,
        {.help = "matches with less parallax become no points, radians", .min = 0.0, .max = 1.0});
  visit("max_rival_ratio", config.max_rival_ratio,
        {.help = "a second motion that explains this share of the best one's matches is ambiguity",
         .min = 0.1,
         .max = 1.0});
  visit_giving_up(config, visit);
}

// Who has lost his place, and where he may be found.
struct LostConfig {
  double max_speed_m_s = 3.0;
  double max_ratio_without_depth = 0.9;
  double max_rival_ratio = 0.75;
  int views_to_resume = 5;
  int frames_to_restart = 30;
};

inline void visit_fields(LostConfig& config, core::FieldVisitor& visit) {
  visit("max_speed_m_s", config.max_speed_m_s,
        {.help = "who is lost is found nowhere beyond what this speed reaches since the last pose; "
                 "without depth there are no metres, and no limit",
         .min = 0.01,
         .max = 1000.0});
  visit("max_ratio_without_depth", config.max_ratio_without_depth,
        {.help = "features.max_ratio of who is lost where depths come from motion: few landmarks "
                 "hold a pose, and the pose sorts out what matches wrongly",
         .min = 0.1,
         .max = 1.0});
  visit("max_rival_ratio", config.max_rival_ratio,
        {.help = "nobody is found while another place of the map has more than this share of the "
                 "best one's inliers, or of its inliers for each landmark in sight, in what the "
                 "map shows at both",
         .min = 0.0,
         .max = 1.0});
  visit("views_to_resume", config.views_to_resume,
        {.help = "so many views must speak for a place; after less than a second one is enough",
         .min = 1,
         .max = 10});
  visit("frames_to_restart", config.frames_to_restart,
        {.help = "with depth, lost for so many frames in a map of fewer than "
                 "start.provisional_keyframes: it is given up for a new start",
         .min = 1,
         .max = 1000000});
}

struct Config {
  double near_radius_px = 12.0;
  double far_radius_px = 48.0;
  double refine_radius_px = 5.0;
  double max_error_px = 4.0;
  int ransac_iterations = 300;
  int min_inliers = 15;
  int weak_inliers = 40;
  int sure_inliers = 100;
  double min_share_by_depth = 0.9;
  double max_scale_change = 4.0;
  LostConfig lost;
  StartConfig start;
  DriftConfig drift;
};

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit("near_radius_px", config.near_radius_px,
        {.help = "search radius around a landmark's predicted pixel", .min = 1.0, .max = 500.0});
  visit("far_radius_px", config.far_radius_px,
        {.help = "the same when that finds no sure pose", .min = 1.0, .max = 1000.0});
  visit("refine_radius_px", config.refine_radius_px,
        {.help = "the same once the pose is known, to collect what was missed",
         .min = 0.5,
         .max = 100.0});
  visit("max_error_px", config.max_error_px,
        {.help = "reprojection error of a RANSAC inlier", .min = 0.1, .max = 50.0});
  visit("ransac_iterations", config.ransac_iterations,
        {.help = "RANSAC samples at most", .min = 1, .max = 100000});
  visit("min_inliers", config.min_inliers,
        {.help = "fewer inliers are no pose", .min = 6, .max = 1000});
  visit("weak_inliers", config.weak_inliers,
        {.help = "fewer inliers are a weak pose", .min = 6, .max = 1000});
  visit("sure_inliers", config.sure_inliers,
        {.help = "fewer inliers near the prediction may agree by chance: the search is widened",
         .min = 6,
         .max = 10000});
  visit("min_share_by_depth", config.min_share_by_depth,
        {.help = "where features hold a weak pose or none, this share of the surfaces that both "
                 "depth pictures show must lie on each other, and holds it; above 1: never",
         .min = 0.0,
         .max = 1.1});
  visit("max_scale_change", config.max_scale_change,
        {.help = "without depth: camera and landmarks in sight so many times slower and nearer (or "
                 "faster and farther) than usual, both at once and lasting: the scale is suspected "
                 "to have changed, and poses are weak; up to 1: nothing is suspected",
         .min = 0.0,
         .max = 1000.0});
  visit("lost", config.lost, {.help = "Who has lost his place, and where he may be found"});
  visit("start", config.start, {.help = "How a camera without depth starts, from two views"});
  visit("drift", config.drift,
        {.help = "Error model of the odometry, from which its information is made"});
}

}  // namespace samewhere::track
