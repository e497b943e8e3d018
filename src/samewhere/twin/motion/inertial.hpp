#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/rig.hpp>
#include <samewhere/core/truth.hpp>
#include <samewhere/twin/motion/motion.hpp>

namespace samewhere::twin {

inline constexpr double kImuRate_hz = 200.0;
inline constexpr double kGravity_m_s2 = 9.81;  // down the world's z

// How an inertial unit errs: white noise, and biases that begin somewhere and walk. The values are
// those of a consumer MEMS unit as in small cameras and phones.
struct InertialNoise {
  double gyroscope_noise_rad_s_sqrt_hz = 1.7e-4;
  double accelerometer_noise_m_s2_sqrt_hz = 2.0e-3;
  double gyroscope_bias_walk_rad_s2_sqrt_hz = 1.9e-5;
  double accelerometer_bias_walk_m_s3_sqrt_hz = 3.0e-3;
  double gyroscope_first_bias_rad_s = 3.0e-3;     // 1 sigma of each axis at stamp 0
  double accelerometer_first_bias_m_s2 = 5.0e-2;  // likewise

  static InertialNoise none() { return {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}; }
};

// What is added to the true measurement of one moment, noise apart.
struct InertialBias {
  Eigen::Vector3d gyroscope_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_m_s2 = Eigen::Vector3d::Zero();
};

// What a unit that sits in the body measures, at stamps k / 200 Hz from 0 to the motion's end:
// angular velocity and specific force (acceleration less gravity: a unit at rest measures 9.81
// upwards) in body axes. The same motion, noise and seed give the same samples.
std::vector<core::ImuSample> inertial_samples(const Motion& motion, const InertialNoise& noise,
                                              std::uint64_t seed);

// The biases in those samples, one per sample.
std::vector<InertialBias> inertial_biases(const Motion& motion, const InertialNoise& noise,
                                          std::uint64_t seed);

// True at these stamps, which ascend and lie within the motion: the body's velocity, and the biases
// of the last sample up to then.
std::vector<core::InertialTruth> inertial_truth(const Motion& motion,
                                                const std::vector<InertialBias>& biases,
                                                const std::vector<double>& stamps_s);

// The unit as a rig describes it: at the body, with the noise densities and the walk of the biases.
core::Imu imu_description(const InertialNoise& noise);

// Order of an InertialState's errors: position (world, m), rotation (body axes, rad), velocity
// (world), gyroscope bias, accelerometer bias; three rows each.
using InertialCovariance = Eigen::Matrix<double, 15, 15>;

struct InertialState {
  double stamp_s = 0.0;
  core::Rigid3 world_from_body;
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  InertialBias bias;  // as far as it is known
  InertialCovariance covariance = InertialCovariance::Zero();

  // 1 sigma of the pose: position (m), rotation (rad).
  core::Vector6d pose_sigma() const;
};

// The motion's true state, with a given bias and no uncertainty.
InertialState true_state(const Motion& motion, double stamp_s, const InertialBias& bias);

// Where the samples lead from a state: midpoint integration between neighbouring samples, and the
// covariance to first order (Forster et al., On-Manifold Preintegration, 2017, section VI). Uses
// the samples from the state's stamp to `until_s`; both must be stamps of samples (to 1 us), or
// ContractError is thrown.
InertialState integrated(const InertialState& state, const std::vector<core::ImuSample>& samples,
                         const InertialNoise& noise, double until_s);

// position difference (world, m) and rotation difference (body axes, rad) of `estimate` from
// `truth`, in the order of the covariance.
core::Vector6d pose_error(const core::Rigid3& estimate, const core::Rigid3& truth);

}  // namespace samewhere::twin
