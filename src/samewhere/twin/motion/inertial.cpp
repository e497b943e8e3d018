#include <algorithm>
#include <cmath>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/twin/motion/inertial.hpp>

namespace samewhere::twin {
namespace {

constexpr double kStampTolerance_s = 1e-6;

Eigen::Vector3d gaussian3(core::Random& random, double sigma) {
  // one after the other: the order of arguments of a call is not defined
  Eigen::Vector3d drawn;
  for (double& value : drawn) value = sigma * random.gaussian();
  return drawn;
}

int num_samples(const Motion& motion) {
  return static_cast<int>(std::floor(motion.duration_s() * kImuRate_hz + 1e-9)) + 1;
}

Eigen::Vector3d specific_force_m_s2(const Motion& motion, double stamp_s) {
  const Eigen::Vector3d up_m_s2(0.0, 0.0, kGravity_m_s2);
  return motion.world_from_body(stamp_s).rotation.conjugate() *
         (motion.acceleration_m_s2(stamp_s) + up_m_s2);
}

std::size_t sample_at(const std::vector<core::ImuSample>& samples, double stamp_s) {
  const auto found = std::lower_bound(
      samples.begin(), samples.end(), stamp_s - kStampTolerance_s,
      [](const core::ImuSample& sample, double stamp) { return sample.stamp_s < stamp; });
  core::require(found != samples.end() && found->stamp_s < stamp_s + kStampTolerance_s,
                "inertial integration begins and ends at stamps of samples");
  return static_cast<std::size_t>(found - samples.begin());
}

// Mean of two neighbouring samples, less the bias.
struct Midpoint {
  double duration_s = 0.0;
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();
};

Midpoint midpoint_of(const core::ImuSample& a, const core::ImuSample& b, const InertialBias& bias) {
  return {b.stamp_s - a.stamp_s,
          0.5 * (a.angular_velocity_rad_s + b.angular_velocity_rad_s) - bias.gyroscope_rad_s,
          0.5 * (a.acceleration_m_s2 + b.acceleration_m_s2) - bias.accelerometer_m_s2};
}

InertialCovariance advanced_covariance(const InertialState& state, const Midpoint& mid,
                                       const InertialNoise& noise) {
  const double dt_s = mid.duration_s;
  const Eigen::Matrix3d world_from_body = state.world_from_body.rotation.toRotationMatrix();
  const Eigen::Matrix3d force_from_tilt = -world_from_body * core::skew(mid.acceleration_m_s2);
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  InertialCovariance F = InertialCovariance::Identity();
  F.block<3, 3>(0, 3) = 0.5 * dt_s * dt_s * force_from_tilt;
  F.block<3, 3>(0, 6) = dt_s * I;
  F.block<3, 3>(0, 12) = -0.5 * dt_s * dt_s * world_from_body;
  F.block<3, 3>(3, 3) = core::exp_so3(-dt_s * mid.angular_velocity_rad_s).toRotationMatrix();
  F.block<3, 3>(3, 9) = -dt_s * I;
  F.block<3, 3>(6, 3) = dt_s * force_from_tilt;
  F.block<3, 3>(6, 12) = -dt_s * world_from_body;
  const auto variance = [&](double density) {
    return Eigen::Vector3d::Constant(density * density);
  };
  Eigen::Matrix<double, 15, 1> variances;
  variances << Eigen::Vector3d::Zero(), variance(noise.gyroscope_noise_rad_s_sqrt_hz),
      variance(noise.accelerometer_noise_m_s2_sqrt_hz),
      variance(noise.gyroscope_bias_walk_rad_s2_sqrt_hz),
      variance(noise.accelerometer_bias_walk_m_s3_sqrt_hz);
  InertialCovariance covariance = F * state.covariance * F.transpose();
  covariance.diagonal() += dt_s * variances;
  return covariance;
}

InertialState advanced(const InertialState& state, const Midpoint& mid,
                       const InertialNoise& noise) {
  const double dt_s = mid.duration_s;
  const Eigen::Quaterniond before = state.world_from_body.rotation;
  const Eigen::Quaterniond halfway =
      before * core::exp_so3(0.5 * dt_s * mid.angular_velocity_rad_s);
  const Eigen::Vector3d acceleration_m_s2 =
      halfway * mid.acceleration_m_s2 - Eigen::Vector3d(0.0, 0.0, kGravity_m_s2);
  InertialState next = state;
  next.stamp_s += dt_s;
  next.world_from_body.rotation =
      (before * core::exp_so3(dt_s * mid.angular_velocity_rad_s)).normalized();
  next.world_from_body.translation +=
      dt_s * state.velocity_m_s + 0.5 * dt_s * dt_s * acceleration_m_s2;
  next.velocity_m_s += dt_s * acceleration_m_s2;
  next.covariance = advanced_covariance(state, mid, noise);
  return next;
}

}  // namespace

std::vector<core::ImuSample> inertial_samples(const Motion& motion, const InertialNoise& noise,
                                              std::uint64_t seed) {
  core::Random random(core::seed_of(seed, "twin.imu.noise", 0));
  const double root_rate = std::sqrt(kImuRate_hz);
  const std::vector<InertialBias> biases = inertial_biases(motion, noise, seed);
  std::vector<core::ImuSample> samples;
  samples.reserve(biases.size());
  for (std::size_t k = 0; k < biases.size(); ++k) {
    const double stamp_s = static_cast<double>(k) / kImuRate_hz;
    const Eigen::Vector3d gyroscope_noise_rad_s =
        gaussian3(random, noise.gyroscope_noise_rad_s_sqrt_hz * root_rate);
    const Eigen::Vector3d accelerometer_noise_m_s2 =
        gaussian3(random, noise.accelerometer_noise_m_s2_sqrt_hz * root_rate);
    samples.push_back(
        {stamp_s,
         motion.angular_velocity_rad_s(stamp_s) + biases[k].gyroscope_rad_s + gyroscope_noise_rad_s,
         specific_force_m_s2(motion, stamp_s) + biases[k].accelerometer_m_s2 +
             accelerometer_noise_m_s2});
  }
  return samples;
}

std::vector<InertialBias> inertial_biases(const Motion& motion, const InertialNoise& noise,
                                          std::uint64_t seed) {
  core::Random random(core::seed_of(seed, "twin.imu.bias", 0));
  const double root_step = std::sqrt(1.0 / kImuRate_hz);
  InertialBias bias;
  bias.gyroscope_rad_s = gaussian3(random, noise.gyroscope_first_bias_rad_s);
  bias.accelerometer_m_s2 = gaussian3(random, noise.accelerometer_first_bias_m_s2);
  std::vector<InertialBias> biases;
  for (int k = 0; k < num_samples(motion); ++k) {
    biases.push_back(bias);
    bias.gyroscope_rad_s += gaussian3(random, noise.gyroscope_bias_walk_rad_s2_sqrt_hz * root_step);
    bias.accelerometer_m_s2 +=
        gaussian3(random, noise.accelerometer_bias_walk_m_s3_sqrt_hz * root_step);
  }
  return biases;
}

std::vector<core::InertialTruth> inertial_truth(const Motion& motion,
                                                const std::vector<InertialBias>& biases,
                                                const std::vector<double>& stamps_s) {
  std::vector<core::InertialTruth> truth;
  for (const double stamp_s : stamps_s) {
    const auto at =
        static_cast<std::size_t>(std::floor((stamp_s + kStampTolerance_s) * kImuRate_hz));
    core::require(at < biases.size(), "inertial truth is asked for within the motion");
    truth.push_back({.stamp_s = stamp_s,
                     .velocity_m_s = motion.velocity_m_s(stamp_s),
                     .gyroscope_bias_rad_s = biases[at].gyroscope_rad_s,
                     .accelerometer_bias_m_s2 = biases[at].accelerometer_m_s2});
  }
  return truth;
}

core::Imu imu_description(const InertialNoise& noise) {
  return {.body_from_imu = {},
          .gyroscope_noise_rad_s_sqrt_hz = noise.gyroscope_noise_rad_s_sqrt_hz,
          .accelerometer_noise_m_s2_sqrt_hz = noise.accelerometer_noise_m_s2_sqrt_hz,
          .gyroscope_bias_walk_rad_s2_sqrt_hz = noise.gyroscope_bias_walk_rad_s2_sqrt_hz,
          .accelerometer_bias_walk_m_s3_sqrt_hz = noise.accelerometer_bias_walk_m_s3_sqrt_hz};
}

core::Vector6d InertialState::pose_sigma() const {
  return covariance.diagonal().head<6>().cwiseSqrt();
}

InertialState true_state(const Motion& motion, double stamp_s, const InertialBias& bias) {
  InertialState state;
  state.stamp_s = stamp_s;
  state.world_from_body = motion.world_from_body(stamp_s);
  state.velocity_m_s = motion.velocity_m_s(stamp_s);
  state.bias = bias;
  return state;
}

InertialState integrated(const InertialState& state, const std::vector<core::ImuSample>& samples,
                         const InertialNoise& noise, double until_s) {
  const std::size_t first = sample_at(samples, state.stamp_s);
  const std::size_t last = sample_at(samples, until_s);
  core::require(first <= last, "inertial integration goes forward in time");
  InertialState now = state;
  for (std::size_t k = first; k < last; ++k) {
    now = advanced(now, midpoint_of(samples[k], samples[k + 1], state.bias), noise);
  }
  return now;
}

core::Vector6d pose_error(const core::Rigid3& estimate, const core::Rigid3& truth) {
  core::Vector6d error;
  error << estimate.translation - truth.translation,
      core::log_so3(truth.rotation.conjugate() * estimate.rotation);
  return error;
}

}  // namespace samewhere::twin
