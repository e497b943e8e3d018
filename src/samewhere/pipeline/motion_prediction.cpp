#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <samewhere/pipeline/motion_prediction.hpp>

namespace samewhere::pipeline {
namespace {

constexpr double kChiSquare = 16.8;  // 99 %, 6 degrees of freedom
constexpr double kSigma_m = 0.05;
constexpr double kSigma_rad = 0.05;
// A person that carries a camera.
constexpr double kAcceleration_m_s2 = 2.0;
constexpr double kAcceleration_rad_s2 = 3.0;
constexpr double kSpeed_m_s = 1.0;
constexpr double kSpeed_rad_s = 1.0;
// Between look-alike places. Both the camera and the look-alike pose are in reach of the last one.
constexpr double kLookAlikes_m = 15.0;
constexpr double kMaxGap_s = 0.5;  // between the frames that tell the velocity
constexpr double kTwoPi = 2.0 * std::numbers::pi;

// Diagonal of the box around the keyframes, on the ground; map units.
double extent(const scene::MapVersion& map) {
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    box.extend(scene::world_from_body(map, core::KeyframeId(i)).translation);
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

}  // namespace

double metre_of(const scene::MapVersion& map) {
  constexpr double kUsualDepth_m = 3.0;
  return is_without_depth(map) ? 1.0 / kUsualDepth_m : 1.0;
}

MotionPrediction::MotionPrediction(const scene::MapVersion& map, const LastMotion& motion,
                                   double stamp_s, double metre) {
  if (motion.last == nullptr) return;
  is_known_ = true;
  const double lost_s = std::max(0.0, stamp_s - motion.last->stamp_s);
  walked_m_ = kSpeed_m_s * lost_s;
  world_from_body_ = world_from_frame(map, *motion.last);
  bool is_velocity_known = false;
  if (motion.before != nullptr) {
    const double step_s = motion.last->stamp_s - motion.before->stamp_s;
    if (step_s > 0.0 && step_s <= kMaxGap_s) {
      const core::Vector6d step =
          core::log_r3so3(inverse(world_from_frame(map, *motion.before)) * world_from_body_);
      world_from_body_ = world_from_body_ * core::exp_r3so3(lost_s / step_s * step);
      is_velocity_known = true;
    }
  }
  const auto grown = [&](double acceleration, double speed) {
    const double of_speed = speed * lost_s;
    return is_velocity_known ? std::min(0.5 * acceleration * lost_s * lost_s, of_speed) : of_speed;
  };
  sigma_ = metre * std::hypot(kSigma_m, grown(kAcceleration_m_s2, kSpeed_m_s));
  sigma_rad_ = std::hypot(kSigma_rad, grown(kAcceleration_rad_s2, kSpeed_rad_s));
}

double MotionPrediction::chi_square(const scene::MapVersion& map,
                                    const core::FramePose& pose) const {
  const core::Rigid3 apart = inverse(world_from_body_) * world_from_frame(map, pose);
  return apart.translation.squaredNorm() / (sigma_ * sigma_) +
         std::pow(core::angle_rad(apart.rotation) / sigma_rad_, 2);
}

bool MotionPrediction::allows(const scene::MapVersion& map, const core::FramePose& pose) const {
  return is_known_ && chi_square(map, pose) <= kChiSquare;
}

// On the ground, with a heading. First the density of the prediction over that of the map, where
// the look-alike of an unmapped place may be; then how rarely look-alikes are so close.
double MotionPrediction::log_likelihood_ratio(const scene::MapVersion& map,
                                              const core::FramePose& pose) const {
  if (!allows(map, pose)) return 0.0;
  const double size = extent(map);
  const double area_ratio = size * size / (kTwoPi * sigma_ * sigma_);
  const double angle_ratio = kTwoPi / (std::sqrt(kTwoPi) * sigma_rad_);
  const double by_density = std::log(std::max(1.0, area_ratio)) +
                            std::log(std::max(1.0, angle_ratio)) - 0.5 * chi_square(map, pose);
  const double reach_ratio = kLookAlikes_m / std::max(2.0 * walked_m_, 1e-3);
  return std::max(by_density, 0.0) + 2.0 * std::log(std::max(1.0, reach_ratio));
}

}  // namespace samewhere::pipeline
