#pragma once

#include <string>

#include <samewhere/core/config.hpp>

namespace samewhere::pipeline {

// What measured the odometry of a file: the row of the drift model (odometry_drift.cpp).
// kFile: the covariances of the file.
enum class OdometrySensor { kFile, kWheel, kLeg, kInertial, kVisual, kPoor };

// Odometry from a file (`samewhere run --odometry`).
struct OdometryConfig {
  std::string file;
  OdometrySensor sensor = OdometrySensor::kFile;
  double drift_per_metre = 0.0;
  double drift_rad_per_metre = 0.0;
  double drift_rad_per_radian = 0.0;
  double drift_rad_per_s = 0.0;
  double noise_per_metre = 0.0;
  double noise_rad_per_metre = 0.0;
  double vertical_ratio = 0.0;
  double max_gap_s = 0.5;
  double gap_per_s = 0.5;
  double gap_rad_per_s = 0.3;
  double keyframe_distance_m = 0.3;
  double search_radius_px = 60.0;

  bool is_used() const { return !file.empty(); }
};

inline void visit_drift(OdometryConfig& config, core::FieldVisitor& visit) {
  visit("drift_per_metre", config.drift_per_metre,
        {.help = "error of distances, constant over the run: standard deviation, metres per metre; "
                 "0: of the sensor, as in the next six",
         .min = 0.0,
         .max = 10.0});
  visit("drift_rad_per_metre", config.drift_rad_per_metre,
        {.help = "error of the heading, the same, radians per metre", .min = 0.0, .max = 10.0});
  visit("drift_rad_per_radian", config.drift_rad_per_radian,
        {.help = "error of turns, the same, radians per radian", .min = 0.0, .max = 10.0});
  visit("drift_rad_per_s", config.drift_rad_per_s,
        {.help = "error of the heading, the same, radians per second", .min = 0.0, .max = 10.0});
  visit("noise_per_metre", config.noise_per_metre,
        {.help = "random error of the position after the first metre (it grows with the root of "
                 "the distance), metres",
         .min = 0.0,
         .max = 10.0});
  visit("noise_rad_per_metre", config.noise_rad_per_metre,
        {.help = "random error of the heading, the same, radians", .min = 0.0, .max = 10.0});
  visit("vertical_ratio", config.vertical_ratio,
        {.help = "errors of height, roll and pitch over those of position and heading",
         .min = 0.0,
         .max = 1.0});
}

inline void visit_fields(OdometryConfig& config, core::FieldVisitor& visit) {
  visit("file", config.file,
        {.help = "odometry of the body, see `samewhere run --odometry`; empty: visual odometry"});
  visit(
      "sensor", config.sensor,
      {.help = "what measured it: the drift model; `file`: its covariances or, without any, wheel",
       .choices = {"file", "wheel", "leg", "inertial", "visual", "poor"}});
  visit_drift(config, visit);
  visit("max_gap_s", config.max_gap_s,
        {.help = "poses are interpolated between rows at most so far apart, s",
         .min = 0.001,
         .max = 3600.0});
  visit("gap_per_s", config.gap_per_s,
        {.help = "longer gaps: additional standard deviation per second, metres",
         .min = 0.0,
         .max = 100.0});
  visit("gap_rad_per_s", config.gap_rad_per_s,
        {.help = "the same of the rotation, radians", .min = 0.0, .max = 10.0});
  visit("keyframe_distance_m", config.keyframe_distance_m,
        {.help = "new keyframe beyond this distance from the last, metres",
         .min = 0.01,
         .max = 100.0});
  visit("search_radius_px", config.search_radius_px,
        {.help = "largest distance of a feature from its landmark as odometry predicts it, pixels",
         .min = 1.0,
         .max = 1000.0});
}

}  // namespace samewhere::pipeline
