#include <algorithm>
#include <cmath>

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
constexpr double kSpeed_m_s = 1.0;  // where the last velocity is not known
constexpr double kSpeed_rad_s = 1.0;
constexpr double kMaxGap_s = 0.5;  // between the frames that tell the velocity
constexpr double kTwoPi = 6.283185307179586;

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
  world_from_body_ = world_from_frame(map, *motion.last);
  double speed_sigma_m = kSpeed_m_s * lost_s;
  double speed_sigma_rad = kSpeed_rad_s * lost_s;
  if (motion.before != nullptr) {
    const double step_s = motion.last->stamp_s - motion.before->stamp_s;
    if (step_s > 0.0 && step_s <= kMaxGap_s) {
      const core::Vector6d step =
          core::log_r3so3(inverse(world_from_frame(map, *motion.before)) * world_from_body_);
      world_from_body_ = world_from_body_ * core::exp_r3so3(lost_s / step_s * step);
      speed_sigma_m = 0.0;
      speed_sigma_rad = 0.0;
    }
  }
  const double half_square = 0.5 * lost_s * lost_s;
  sigma_ = metre * std::hypot(kSigma_m, speed_sigma_m, kAcceleration_m_s2 * half_square);
  sigma_rad_ = std::hypot(kSigma_rad, speed_sigma_rad, kAcceleration_rad_s2 * half_square);
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

// On the ground, with a heading: the density of the prediction over that of the map.
double MotionPrediction::log_likelihood_ratio(const scene::MapVersion& map,
                                              const core::FramePose& pose) const {
  if (!is_known_) return 0.0;
  const double size = extent(map);
  const double area_ratio = size * size / (kTwoPi * sigma_ * sigma_);
  const double angle_ratio = kTwoPi / (std::sqrt(kTwoPi) * sigma_rad_);
  const double at_mean = std::log(std::max(1.0, area_ratio) * std::max(1.0, angle_ratio));
  return std::max(at_mean - 0.5 * chi_square(map, pose), 0.0);
}

}  // namespace samewhere::pipeline
