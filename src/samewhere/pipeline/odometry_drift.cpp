#include <samewhere/pipeline/odometry_drift.hpp>

namespace samewhere::pipeline {
namespace {

constexpr double kLeast_m = 1e-3;
constexpr double kLeast_rad = 1e-4;

// A bias is not quite constant: half of it varies, over such a distance, turn and time.
constexpr double kVaryingRatio = 0.5;
constexpr double kCorrelation_m = 10.0;
constexpr double kCorrelation_rad = 3.0;
constexpr double kCorrelation_s = 10.0;

// Columns as DriftRates; reasons and sources: docs/decisions/033-odometry-from-a-file.md.
DriftRates rates_of(OdometrySensor sensor) {
  switch (sensor) {
    case OdometrySensor::kFile:
      return {};
    case OdometrySensor::kWheel:
      return {{.per_metre = 0.02, .rad_per_metre = 0.002, .rad_per_radian = 0.02}, 0.03, 0.01, 0.1};
    case OdometrySensor::kLeg:
      return {{.per_metre = 0.05, .rad_per_metre = 0.005, .rad_per_radian = 0.05}, 0.1, 0.02, 0.2};
    case OdometrySensor::kInertial:
      return {
          {.per_metre = 0.05, .rad_per_metre = 0.002, .rad_per_radian = 0.01, .rad_per_s = 5e-4},
          0.1,
          0.005,
          0.3};
    case OdometrySensor::kVisual:
      return {
          {.per_metre = 0.015, .rad_per_metre = 0.001, .rad_per_radian = 0.01}, 0.02, 0.005, 1.0};
    case OdometrySensor::kPoor:
      return {{.per_metre = 0.1, .rad_per_metre = 0.02, .rad_per_radian = 0.1}, 0.1, 0.03, 0.2};
  }
  return {};
}

void set_if_given(double given, double& rate) {
  if (given > 0.0) rate = given;
}

double square(double value) { return value * value; }

// Across the axis 1, along it `along`.
Eigen::Matrix3d shape(const Eigen::Vector3d& axis, double across, double along) {
  const Eigen::Matrix3d projection = axis * axis.transpose();
  return square(across) * (Eigen::Matrix3d::Identity() - projection) + square(along) * projection;
}

}  // namespace

DriftRates drift_rates(const OdometryConfig& config) {
  DriftRates rates = rates_of(config.sensor);
  set_if_given(config.drift_per_metre, rates.bias.per_metre);
  set_if_given(config.drift_rad_per_metre, rates.bias.rad_per_metre);
  set_if_given(config.drift_rad_per_radian, rates.bias.rad_per_radian);
  set_if_given(config.drift_rad_per_s, rates.bias.rad_per_s);
  set_if_given(config.noise_per_metre, rates.noise_per_metre);
  set_if_given(config.noise_rad_per_metre, rates.noise_rad_per_metre);
  set_if_given(config.vertical_ratio, rates.vertical_ratio);
  rates.bias.tilt_ratio = rates.vertical_ratio;
  return rates;
}

verify::SystematicDrift systematic_drift(const OdometryConfig& config) {
  return config.is_used() ? drift_rates(config).bias : verify::SystematicDrift{};
}

core::Matrix6d gap_covariance(double gap_s, const OdometryConfig& config) {
  core::Vector6d variances;
  variances << Eigen::Vector3d::Constant(square(kLeast_m) + square(config.gap_per_s * gap_s)),
      Eigen::Vector3d::Constant(square(kLeast_rad) + square(config.gap_rad_per_s * gap_s));
  return variances.asDiagonal();
}

core::Matrix6d step_covariance(const OdometryStep& step, const DriftRates& rates,
                               const OdometryConfig& config) {
  const verify::SystematicDrift& bias = rates.bias;
  const double position = step.length_m * (square(rates.noise_per_metre) +
                                           square(kVaryingRatio * bias.per_metre) * kCorrelation_m);
  const double heading =
      step.length_m * (square(rates.noise_rad_per_metre) +
                       square(kVaryingRatio * bias.rad_per_metre) * kCorrelation_m) +
      step.turned_rad * square(kVaryingRatio * bias.rad_per_radian) * kCorrelation_rad +
      step.duration_s * square(kVaryingRatio * bias.rad_per_s) * kCorrelation_s;
  core::Matrix6d covariance = gap_covariance(step.gap_s, config);
  const double vertical = step.up_in_before ? rates.vertical_ratio : 1.0;
  const Eigen::Vector3d up = step.up_in_before.value_or(Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d up_in_after = step.before_from_after.rotation.conjugate() * up;
  covariance.topLeftCorner<3, 3>() += position * shape(up, 1.0, vertical);
  covariance.bottomRightCorner<3, 3>() += heading * shape(up_in_after, vertical, 1.0);
  return covariance;
}

}  // namespace samewhere::pipeline
