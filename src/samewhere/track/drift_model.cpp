#include <Eigen/LU>

#include <samewhere/track/drift_model.hpp>

namespace samewhere::track {
namespace {

// No frame is located better.
constexpr double kLeast_m = 1e-4;
constexpr double kLeast_rad = 1e-5;

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

// Error of reference_from_body, [translation in the reference; rotation on the right], by an error
// of camera_from_reference, [translation; rotation on the left].
core::Matrix6d error_by_error(const core::Rigid3& camera_from_reference,
                              const core::Rigid3& body_from_camera) {
  const core::Rigid3 camera_from_body = inverse(body_from_camera);
  const Eigen::Matrix3d reference_from_camera =
      camera_from_reference.rotation.conjugate().toRotationMatrix();
  core::Matrix6d by = core::Matrix6d::Zero();
  by.topLeftCorner<3, 3>() = -reference_from_camera;
  by.topRightCorner<3, 3>() =
      reference_from_camera *
      cross_matrix(camera_from_body.translation - camera_from_reference.translation);
  by.bottomRightCorner<3, 3>() = -body_from_camera.rotation.toRotationMatrix();
  return by;
}

}  // namespace

core::Matrix6d odometry_information(const core::Rigid3& camera_from_reference,
                                    const core::Rigid3& body_from_camera,
                                    const core::Matrix6d& covariance, bool is_weak,
                                    const DriftConfig& config) {
  const core::Matrix6d by = error_by_error(camera_from_reference, body_from_camera);
  core::Matrix6d found = config.factor * config.factor * by * covariance * by.transpose();
  const core::Rigid3 reference_from_body = inverse(body_from_camera * camera_from_reference);
  const double sigma_m = kLeast_m + config.per_metre * reference_from_body.translation.norm();
  const double sigma_rad =
      kLeast_rad + config.per_radian * core::angle_rad(reference_from_body.rotation);
  found.diagonal().head<3>().array() += sigma_m * sigma_m;
  found.diagonal().tail<3>().array() += sigma_rad * sigma_rad;
  const double weak = is_weak ? config.weak_factor : 1.0;
  return (weak * weak * found).inverse();
}

DriftConfig drift_of(const features::View& view, const DriftConfig& config) {
  DriftConfig drift = config;
  if (!has_depth(view)) drift.factor = config.factor_without_depth;
  return drift;
}

core::Matrix6d seen_from(const core::Rigid3& new_from_old_reference,
                         const core::Matrix6d& information) {
  core::Matrix6d turn = core::Matrix6d::Identity();
  turn.topLeftCorner<3, 3>() = new_from_old_reference.rotation.toRotationMatrix();
  return turn * information * turn.transpose();
}

}  // namespace samewhere::track
