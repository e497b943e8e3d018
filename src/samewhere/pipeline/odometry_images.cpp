#include <Eigen/LU>

#include <samewhere/pipeline/odometry_images.hpp>

namespace samewhere::pipeline {
namespace {

constexpr double kLiftSpeed_m_s = 1.0;  // of what no image has seen
constexpr double kVisualFactor = 4.0;   // covariances by features alone are too small
constexpr double kVisual_m = 0.02;
constexpr double kVisual_rad = 0.002;
constexpr double kVisualEdge_m = 0.03;  // of a gap: no bundle adjustment follows
constexpr double kVisualEdge_rad = 0.005;
constexpr double kMaxChiSquare = 21.1;  // 3 degrees of freedom, 99.99 %

double variance_of(double sigma) { return sigma * sigma; }

// Adds what images and odometry differ by, if the covariances do not explain it: then true.
bool enlarge_if_contradicted(const Eigen::Vector3d& difference, const Eigen::Matrix3d& visual,
                             double systematic, double least, Eigen::Ref<Eigen::Matrix3d> own) {
  const Eigen::Matrix3d expected =
      own + kVisualFactor * visual +
      (variance_of(systematic) + variance_of(least)) * Eigen::Matrix3d::Identity();
  if (difference.dot(expected.inverse() * difference) <= kMaxChiSquare) return false;
  own += difference * difference.transpose();
  return true;
}

geometry::UncertainPose visual_motion(const geometry::UncertainPose& images) {
  core::Vector6d least;
  least << Eigen::Vector3d::Constant(variance_of(kVisualEdge_m)),
      Eigen::Vector3d::Constant(variance_of(kVisualEdge_rad));
  return {images.a_from_b, kVisualFactor * images.covariance + core::Matrix6d(least.asDiagonal())};
}

// Height, roll and pitch of the images.
void take_height(const geometry::UncertainPose& images, const Eigen::Vector3d& normal,
                 geometry::UncertainPose& motion) {
  core::Rigid3& moved = motion.a_from_b;
  const core::Rigid3& seen = images.a_from_b;
  const Eigen::Vector3d normal_in_after = moved.rotation.conjugate() * normal;
  Eigen::Vector3d tilt = core::log_so3(moved.rotation.conjugate() * seen.rotation);
  tilt -= normal_in_after * normal_in_after.dot(tilt);
  moved.rotation = (moved.rotation * core::exp_so3(tilt)).normalized();
  moved.translation += normal * normal.dot(seen.translation - moved.translation);
  const double variance =
      kVisualFactor * normal.dot(images.covariance.topLeftCorner<3, 3>() * normal) +
      variance_of(kVisual_m);
  motion.covariance.topLeftCorner<3, 3>() += variance * normal * normal.transpose();
}

}  // namespace

CombinedMotion combine_with_images(const OdometryMotion& odometry,
                                   const std::optional<geometry::UncertainPose>& images,
                                   const verify::SystematicDrift& drift) {
  CombinedMotion motion{odometry.before_from_after};
  const auto& normal = odometry.normal_in_before;
  if (!images) {
    if (normal) {
      motion.covariance.topLeftCorner<3, 3>() +=
          variance_of(kLiftSpeed_m_s * odometry.duration_s) * *normal * normal->transpose();
    }
    return motion;
  }
  if (odometry.has_gap) return {visual_motion(*images)};
  if (normal) take_height(*images, *normal, motion);
  const core::Rigid3& moved = motion.a_from_b;
  const double length_m = moved.translation.norm();
  const bool is_elsewhere = enlarge_if_contradicted(
      images->a_from_b.translation - moved.translation, images->covariance.topLeftCorner<3, 3>(),
      drift.per_metre * length_m, kVisual_m, motion.covariance.topLeftCorner<3, 3>());
  const bool is_turned = enlarge_if_contradicted(
      core::log_so3(moved.rotation.conjugate() * images->a_from_b.rotation),
      images->covariance.bottomRightCorner<3, 3>(),
      drift.rad_per_metre * length_m + drift.rad_per_radian * core::angle_rad(moved.rotation) +
          drift.rad_per_s * odometry.duration_s,
      kVisual_rad, motion.covariance.bottomRightCorner<3, 3>());
  motion.is_contradicted = is_elsewhere || is_turned;
  return motion;
}

}  // namespace samewhere::pipeline
