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
        {.help = "with depth: standard deviation of odometry over that of the residuals",
         .min = 0.01,
         .max = 100.0});
  visit("factor_without_depth", config.factor_without_depth,
        {.help = "without depth: the same", .min = 0.01, .max = 100.0});
  visit("per_metre", config.per_metre,
        {.help = "standard deviation per metre of translation, metres", .min = 0.0, .max = 1.0});
  visit("per_radian", config.per_radian,
        {.help = "standard deviation per radian of rotation, radians", .min = 0.0, .max = 1.0});
  visit("weak_factor", config.weak_factor,
        {.help = "factor on all standard deviations while the pose is weak",
         .min = 1.0,
         .max = 100.0});
}

// What relates two views (two_view_model.hpp).
enum class StartModel { kHomographyOrEssential, kFundamental };

// How a camera without depth starts, from two views.
struct InitializationConfig {
  StartModel model = StartModel::kHomographyOrEssential;
  int min_matches = 100;
  int min_points = 60;
  double max_error_px = 2.0;
  int ransac_iterations = 200;
  double min_homography_ratio = 0.45;
  double min_parallax_rad = 0.02;
  double min_point_parallax_rad = 0.01;
  double max_competing_ratio = 0.7;
  int max_waiting_frames = 300;
  int provisional_keyframes = 20;
  double provisional_s = 5.0;
};

// When a start is given up.
inline void visit_giving_up(InitializationConfig& config, core::FieldVisitor& visit) {
  visit("max_waiting_frames", config.max_waiting_frames,
        {.help = "frames after which the first view is replaced", .min = 1, .max = 100000});
  visit("provisional_keyframes", config.provisional_keyframes,
        {.help = "a map with fewer keyframes is re-initialized after tracking loss",
         .min = 0,
         .max = 10000});
  visit("provisional_s", config.provisional_s,
        {.help = "with depth: a map tracked for less is re-initialized if it is lost for longer, s",
         .min = 0.0,
         .max = 3600.0});
}

inline void visit_fields(InitializationConfig& config, core::FieldVisitor& visit) {
  visit("model", config.model,
        {.help = "two-view model: the better of homography and essential matrix, or the "
                 "fundamental matrix, eq. (18)-(22)",
         .choices = {"homography_or_essential", "fundamental"}});
  visit("min_matches", config.min_matches,
        {.help = "least matches of the two views; with fewer the later view becomes the first",
         .min = 8,
         .max = 10000});
  visit("min_points", config.min_points,
        {.help = "least triangulated points in front of both cameras", .min = 8, .max = 10000});
  visit("max_error_px", config.max_error_px,
        {.help = "largest reprojection error of an inlier, pixels", .min = 0.1, .max = 50.0});
  visit("ransac_iterations", config.ransac_iterations,
        {.help = "largest number of RANSAC samples per model", .min = 1, .max = 100000});
  visit("min_homography_ratio", config.min_homography_ratio,
        {.help = "least share of the homography in the two scores for which it is chosen; with "
                 "`fundamental`: for which the start is rejected (ORB-SLAM, TRO 2015)",
         .min = 0.0,
         .max = 1.0});
  visit("min_parallax_rad", config.min_parallax_rad,
        {.help = "least median parallax, radians", .min = 0.001, .max = 1.0});
  visit("min_point_parallax_rad", config.min_point_parallax_rad,
        {.help = "least parallax of a triangulated point, radians", .min = 0.0, .max = 1.0});
  visit("max_competing_ratio", config.max_competing_ratio,
        {.help = "ambiguous if a second motion has more than this share of the best one's inliers",
         .min = 0.1,
         .max = 1.0});
  visit_giving_up(config, visit);
}

// Relocalization.
struct RelocalizationConfig {
  double max_speed_m_s = 3.0;
  double max_ratio_without_depth = 0.9;
  double max_competing_ratio = 0.75;
  int min_views = 5;
  double min_log_ratio = 2.5;
  double common_length_m = 60.0;
  int reinitialize_after_frames = 30;
};

inline void visit_fields(RelocalizationConfig& config, core::FieldVisitor& visit) {
  visit(
      "max_speed_m_s", config.max_speed_m_s,
      {.help =
           "with depth: poses beyond the reach of this speed since the last pose are rejected, m/s",
       .min = 0.01,
       .max = 1000.0});
  visit("max_ratio_without_depth", config.max_ratio_without_depth,
        {.help = "without depth: features.max_ratio in relocalization", .min = 0.1, .max = 1.0});
  visit("max_competing_ratio", config.max_competing_ratio,
        {.help = "ambiguous if a competing place has more than this share of the best one's "
                 "inliers, or of its inliers per visible landmark",
         .min = 0.0,
         .max = 1.0});
  visit("min_views", config.min_views,
        {.help = "views that must support the place; `prior: unique`: one is enough within 1 s of "
                 "tracking loss",
         .min = 1,
         .max = 10});
  visit("min_log_ratio", config.min_log_ratio,
        {.help = "`prior: repetitive`: logarithm of the likelihood ratio of the place, against a "
                 "look-alike that is not in the map, that confirms a relocalization; negative: "
                 "takes it back",
         .min = 0.0,
         .max = 100.0});
  visit("common_length_m", config.common_length_m,
        {.help = "`prior: repetitive`: how far look-alike places go on alike, on average; longer "
                 "corridors that look alike from end to end need more, metres",
         .min = 1.0,
         .max = 10000.0});
  visit("reinitialize_after_frames", config.reinitialize_after_frames,
        {.help = "with depth: lost frames after which a map with fewer than provisional_keyframes "
                 "is re-initialized",
         .min = 1,
         .max = 1000000});
}

// Motion between two depth images, point to plane (depth_alignment.hpp).
struct DepthAlignmentConfig {
  double min_agreement = 0.9;
  int iterations = 20;
  double first_tukey = 12.0;
  double tukey = 4.0;
  double max_distance_m = 0.3;
  double max_step_ratio = 0.1;
  double min_patch_ratio = 0.0625;
  double min_eigenvalue = 0.005;
  double correlation = 10.0;
  double max_sigma_m = 0.03;
  double max_sigma_rad = 0.02;
  double sigma_m = 0.002;
  double sigma_per_square_m = 0.002;
};

inline void visit_alignment_method(DepthAlignmentConfig& config, core::FieldVisitor& visit) {
  visit("iterations", config.iterations,
        {.help = "largest number of Gauss-Newton iterations",
         .min = 1,
         .max = 200,
         .is_expert = true});
  visit("first_tukey", config.first_tukey,
        {.help = "width of the Tukey loss in the first iteration, standard deviations",
         .min = 1.0,
         .max = 100.0,
         .is_expert = true});
  visit("tukey", config.tukey,
        {.help = "width of the Tukey loss in the last iteration, standard deviations (4.685: 95 % "
                 "efficiency)",
         .min = 1.0,
         .max = 100.0,
         .is_expert = true});
  visit("max_distance_m", config.max_distance_m,
        {.help = "largest distance of associated points, metres",
         .min = 0.01,
         .max = 10.0,
         .is_expert = true});
  visit("max_step_ratio", config.max_step_ratio,
        {.help = "relative depth step that separates two surfaces",
         .min = 0.001,
         .max = 1.0,
         .is_expert = true});
}

inline void visit_alignment_acceptance(DepthAlignmentConfig& config, core::FieldVisitor& visit) {
  visit("min_patch_ratio", config.min_patch_ratio,
        {.help = "least share of the 8 x 8 pixel patches that must be inliers",
         .min = 0.0,
         .max = 1.0,
         .is_expert = true});
  visit("min_eigenvalue", config.min_eigenvalue,
        {.help = "least eigenvalue of the mean normal matrix; noise on one bare wall has 0.0005",
         .min = 0.0,
         .max = 1.0,
         .is_expert = true});
  visit("correlation", config.correlation,
        {.help = "factor on standard deviations, because errors of neighbouring patches correlate",
         .min = 1.0,
         .max = 1000.0,
         .is_expert = true});
  visit("max_sigma_m", config.max_sigma_m,
        {.help = "largest standard deviation of the translation, metres",
         .min = 1e-4,
         .max = 10.0,
         .is_expert = true});
  visit("max_sigma_rad", config.max_sigma_rad,
        {.help = "largest standard deviation of the rotation, radians",
         .min = 1e-4,
         .max = 3.0,
         .is_expert = true});
  visit("sigma_m", config.sigma_m,
        {.help = "standard deviation of a depth, constant part, metres",
         .min = 1e-5,
         .max = 1.0,
         .is_expert = true});
  visit("sigma_per_square_m", config.sigma_per_square_m,
        {.help = "the part that grows with the square of the depth, metres per square metre",
         .min = 0.0,
         .max = 1.0,
         .is_expert = true});
}

inline void visit_fields(DepthAlignmentConfig& config, core::FieldVisitor& visit) {
  visit("min_agreement", config.min_agreement,
        {.help = "few features: least share of the surface points common to both depth images "
                 "that must agree; above 1: off",
         .min = 0.0,
         .max = 1.1});
  visit_alignment_method(config, visit);
  visit_alignment_acceptance(config, visit);
}

// Moving objects: landmarks in front of a surface seen before (free_space.hpp).
struct FreeSpaceConfig {
  double margin_m = 0.15;
  double margin_per_metre = 0.1;
};

inline void visit_fields(FreeSpaceConfig& config, core::FieldVisitor& visit) {
  visit("margin_m", config.margin_m,
        {.help = "a point nearer than the surface of earlier depth images by more is moving, "
                 "metres",
         .min = 0.0,
         .max = 10.0,
         .is_expert = true});
  visit(
      "margin_per_metre", config.margin_per_metre,
      {.help = "additional margin per metre of depth", .min = 0.0, .max = 1.0, .is_expert = true});
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
  double max_scale_change = 4.0;
  RelocalizationConfig relocalization;
  InitializationConfig initialization;
  DriftConfig drift;
  DepthAlignmentConfig depth_alignment;
  FreeSpaceConfig free_space;
};

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit("near_radius_px", config.near_radius_px,
        {.help = "search radius around a landmark's predicted pixel, pixels",
         .min = 1.0,
         .max = 500.0});
  visit("far_radius_px", config.far_radius_px,
        {.help = "search radius after too few inliers, pixels", .min = 1.0, .max = 1000.0});
  visit("refine_radius_px", config.refine_radius_px,
        {.help = "search radius with the estimated pose, pixels", .min = 0.5, .max = 100.0});
  visit("max_error_px", config.max_error_px,
        {.help = "largest reprojection error of a RANSAC inlier, pixels", .min = 0.1, .max = 50.0});
  visit("ransac_iterations", config.ransac_iterations,
        {.help = "largest number of RANSAC samples", .min = 1, .max = 100000});
  visit("min_inliers", config.min_inliers,
        {.help = "least inliers of a pose", .min = 6, .max = 1000});
  visit("weak_inliers", config.weak_inliers,
        {.help = "fewer inliers: the pose is weak", .min = 6, .max = 1000});
  visit("sure_inliers", config.sure_inliers,
        {.help = "fewer inliers after the first search: the search radius is enlarged",
         .min = 6,
         .max = 10000});
  visit("max_scale_change", config.max_scale_change,
        {.help = "without depth: change of speed and of landmark depth, both by this factor, from "
                 "which scale drift is suspected and poses are weak; up to 1: off",
         .min = 0.0,
         .max = 1000.0});
  visit("relocalization", config.relocalization, {.help = "Relocalization"});
  visit("initialization", config.initialization,
        {.help = "Initialization of one camera without depth, from two views"});
  visit("drift", config.drift,
        {.help = "Drift model of the odometry, from which its information is derived"});
  visit("depth_alignment", config.depth_alignment,
        {.help = "Depth alignment, where features are few (decision 024)"});
  visit("free_space", config.free_space, {.help = "Moving objects by free space"});
}

}  // namespace samewhere::track
