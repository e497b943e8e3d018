#pragma once

#include <samewhere/core/config.hpp>

namespace samewhere::track {

// Standard deviations of the odometry between a frame and its reference keyframe.
struct DriftConfig {
  double base_m = 0.01;
  double per_metre = 0.02;
  double base_rad = 0.004;
  double per_radian = 0.02;
  double weak_factor = 3.0;
};

inline void visit_fields(DriftConfig& config, core::FieldVisitor& visit) {
  visit("base_m", config.base_m,
        {.help = "error of any measured pose, metres", .min = 1e-6, .max = 10.0});
  visit("per_metre", config.per_metre,
        {.help = "error per metre moved, metres", .min = 0.0, .max = 1.0});
  visit("base_rad", config.base_rad,
        {.help = "error of any measured pose, radians", .min = 1e-6, .max = 3.0});
  visit("per_radian", config.per_radian,
        {.help = "error per radian turned, radians", .min = 0.0, .max = 1.0});
  visit("weak_factor", config.weak_factor,
        {.help = "all errors times this while tracking is weak", .min = 1.0, .max = 100.0});
}

struct Config {
  double near_radius_px = 12.0;
  double far_radius_px = 48.0;
  double refine_radius_px = 5.0;
  double max_error_px = 4.0;
  int ransac_iterations = 300;
  int min_inliers = 15;
  int weak_inliers = 40;
  DriftConfig drift;
};

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit("near_radius_px", config.near_radius_px,
        {.help = "search radius around a landmark's predicted pixel", .min = 1.0, .max = 500.0});
  visit("far_radius_px", config.far_radius_px,
        {.help = "the same when the prediction failed", .min = 1.0, .max = 1000.0});
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
  visit("drift", config.drift,
        {.help = "Error model of the odometry, from which its information is made"});
}

}  // namespace samewhere::track
