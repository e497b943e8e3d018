#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include <samewhere/pipeline/motion_prediction.hpp>
#include <samewhere/verify/look_alike.hpp>
#include <samewhere/verify/measure_odometry.hpp>

namespace samewhere::pipeline {
namespace {

constexpr double kChiSquare = 16.8;  // 99 %, 6 degrees of freedom
constexpr double kSigma_m = 0.05;
constexpr double kSigma_rad = 0.05;
// A person that carries a camera, or a robot indoors: it stops, or turns.
constexpr double kAcceleration_m_s2 = 2.0;
constexpr double kAcceleration_rad_s2 = 3.0;
constexpr double kSpeed_m_s = 0.5;
constexpr double kSpeed_rad_s = 1.0;
// A camera that seems to be faster has wrong stamps (image lists have assumed ones), or is no
// person's.
constexpr double kMaxSpeed_m_s = 1.5;
// Look-alikes that are not in the map: so many at the least distance, in a reach of that size.
constexpr double kLookAlikes = 0.3;
constexpr double kNoneInReach = 6.0;  // log-likelihood ratio
constexpr double kMaxGap_s = 0.5;     // between the frames that tell the velocity

}  // namespace

double metre_of(const scene::MapVersion& map) {
  constexpr double kUsualDepth_m = 3.0;
  return has_scale_drift(map) ? 1.0 / kUsualDepth_m : 1.0;
}

MotionPrediction::MotionPrediction(const scene::MapVersion& map, const LastMotion& motion,
                                   double stamp_s, const verify::Config& config)
    : least_distance_(verify::least_look_alike_distance(map, config)) {
  if (motion.last == nullptr) return;
  is_known_ = true;
  const double metre = metre_of(map);
  double lost_s = std::max(0.0, stamp_s - motion.last->stamp_s);
  world_from_body_ = world_from_frame(map, *motion.last);
  last_position_ = world_from_body_.translation;
  bool is_velocity_known = false;
  if (motion.before != nullptr) {
    const double step_s = motion.last->stamp_s - motion.before->stamp_s;
    if (step_s > 0.0 && step_s <= kMaxGap_s) {
      const core::Vector6d step =
          core::log_r3so3(inverse(world_from_frame(map, *motion.before)) * world_from_body_);
      world_from_body_ = world_from_body_ * core::exp_r3so3(lost_s / step_s * step);
      is_velocity_known = true;
      const double speed_m_s = step.head<3>().norm() / (step_s * metre);
      lost_s *= std::max(1.0, speed_m_s / kMaxSpeed_m_s);
    }
  }
  const auto grown = [&](double acceleration, double speed) {
    const double of_speed = speed * lost_s;
    return is_velocity_known ? std::min(0.5 * acceleration * lost_s * lost_s, of_speed) : of_speed;
  };
  sigma_ = metre * std::hypot(kSigma_m, grown(kAcceleration_m_s2, kSpeed_m_s));
  reach_ = metre * (kSigma_m + kMaxSpeed_m_s * lost_s);
  sigma_rad_ = std::hypot(kSigma_rad, grown(kAcceleration_rad_s2, kSpeed_rad_s));
}

core::Vector6d MotionPrediction::error(const scene::MapVersion& map,
                                       const core::FramePose& pose) const {
  return core::log_r3so3(inverse(world_from_body_) * world_from_frame(map, pose));
}

core::Matrix6d MotionPrediction::covariance() const {
  core::Vector6d variances;
  variances << Eigen::Vector3d::Constant(sigma_ * sigma_),
      Eigen::Vector3d::Constant(sigma_rad_ * sigma_rad_);
  return variances.asDiagonal();
}

bool MotionPrediction::allows(const scene::MapVersion& map, const core::FramePose& pose) const {
  if (!is_known_) return false;
  const core::Vector6d apart = error(map, pose);
  return apart.dot(covariance().inverse() * apart) <= kChiSquare;
}

// A look-alike of a place in reach of the last pose is farther from it than the least distance less
// that reach.
double MotionPrediction::log_likelihood_ratio(const scene::MapVersion& map,
                                              const core::FramePose& pose) const {
  if (!allows(map, pose)) return 0.0;
  double by_reach = 0.0;
  const double moved = (world_from_frame(map, pose).translation - last_position_).norm();
  if (moved + reach_ < least_distance_) by_reach = kNoneInReach;
  const double gain = verify::look_alike_gain(error(map, pose), covariance(), least_distance_);
  const double num_in_reach = std::min(1.0, kLookAlikes * std::pow(reach_ / least_distance_, 2));
  return std::max(by_reach, 0.5 * gain - std::log(num_in_reach));
}

}  // namespace samewhere::pipeline
