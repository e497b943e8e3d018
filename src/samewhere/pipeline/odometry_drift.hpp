#pragma once

#include <optional>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/pipeline/odometry_config.hpp>
#include <samewhere/verify/systematic_drift.hpp>

namespace samewhere::pipeline {

// Drift of odometry from a file, standard deviations.
struct DriftRates {
  verify::SystematicDrift bias;  // constant over the run
  double noise_per_metre = 0.0;  // metres after the first metre, as the root of the distance
  double noise_rad_per_metre = 0.0;
  double vertical_ratio = 1.0;  // of height, roll and pitch
};

// Of the sensor, with the values that the settings give (docs/decisions/033).
DriftRates drift_rates(const OdometryConfig& config);

// The constant part, of the run's odometry; none without a file.
verify::SystematicDrift systematic_drift(const OdometryConfig& config);

// What odometry went through from one moment to the next.
struct OdometryStep {
  core::Rigid3 before_from_after;
  double length_m = 0.0;
  double turned_rad = 0.0;
  double duration_s = 0.0;
  double gap_s = 0.0;                           // without rows
  std::optional<Eigen::Vector3d> up_in_before;  // the axis that it turns about; none: any
};

// Covariance of before_from_after, [m; rad]: the random part, and a share of the bias that varies
// along the run. What of the bias is constant is no part of it (verify/systematic_drift.hpp).
core::Matrix6d step_covariance(const OdometryStep& step, const DriftRates& rates,
                               const OdometryConfig& config);

// The part of it for a gap, and a least error that no odometry is without.
core::Matrix6d gap_covariance(double gap_s, const OdometryConfig& config);

}  // namespace samewhere::pipeline
