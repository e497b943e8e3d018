#include <cmath>

#include <samewhere/core/rigid3.hpp>

namespace samewhere::core {

Rigid3 Rigid3::from_matrix(const Eigen::Matrix4d& a_from_b) {
  const Eigen::Matrix3d rotation = a_from_b.topLeftCorner<3, 3>();
  return {Eigen::Quaterniond(rotation).normalized(), a_from_b.topRightCorner<3, 1>()};
}

Eigen::Matrix4d Rigid3::matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = rotation.toRotationMatrix();
  m.topRightCorner<3, 1>() = translation;
  return m;
}

Sim3 Sim3::from_rigid(const Rigid3& a_from_b) {
  return {1.0, a_from_b.rotation, a_from_b.translation};
}

Rigid3 operator*(const Rigid3& a_from_b, const Rigid3& b_from_c) {
  return {(a_from_b.rotation * b_from_c.rotation).normalized(),
          a_from_b.rotation * b_from_c.translation + a_from_b.translation};
}

Rigid3 inverse(const Rigid3& a_from_b) {
  const Eigen::Quaterniond rotation = a_from_b.rotation.conjugate();
  return {rotation, -(rotation * a_from_b.translation)};
}

Sim3 operator*(const Sim3& a_from_b, const Sim3& b_from_c) {
  return {a_from_b.scale * b_from_c.scale, (a_from_b.rotation * b_from_c.rotation).normalized(),
          a_from_b.scale * (a_from_b.rotation * b_from_c.translation) + a_from_b.translation};
}

Eigen::Vector3d operator*(const Sim3& a_from_b, const Eigen::Vector3d& x_in_b) {
  return a_from_b.scale * (a_from_b.rotation * x_in_b) + a_from_b.translation;
}

Sim3 inverse(const Sim3& a_from_b) {
  const Eigen::Quaterniond rotation = a_from_b.rotation.conjugate();
  const double scale = 1.0 / a_from_b.scale;
  return {scale, rotation, -scale * (rotation * a_from_b.translation)};
}

Rigid3 rigid_part(const Sim3& a_from_b) { return {a_from_b.rotation, a_from_b.translation}; }

Eigen::Quaterniond exp_so3(const Eigen::Vector3d& rotation_rad) {
  const double angle = rotation_rad.norm();
  // sin(angle / 2) / angle; its Taylor series where the quotient loses digits
  const double k = angle < 1e-6 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  const Eigen::Vector3d xyz = k * rotation_rad;
  return Eigen::Quaterniond(std::cos(0.5 * angle), xyz.x(), xyz.y(), xyz.z()).normalized();
}

Eigen::Vector3d log_so3(const Eigen::Quaterniond& rotation) {
  // q and -q are the same rotation: take the one of the shorter way
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d xyz = sign * rotation.vec();
  const double w = sign * rotation.w();
  const double n = xyz.norm();
  const double k = n < 1e-9 ? 2.0 / w : 2.0 * std::atan2(n, w) / n;
  return k * xyz;
}

Rigid3 exp_r3so3(const Vector6d& tangent) {
  return {exp_so3(tangent.tail<3>()), tangent.head<3>()};
}

Vector6d log_r3so3(const Rigid3& a_from_b) {
  Vector6d tangent;
  tangent << a_from_b.translation, log_so3(a_from_b.rotation);
  return tangent;
}

double angle_rad(const Eigen::Quaterniond& rotation) {
  return 2.0 * std::atan2(rotation.vec().norm(), std::abs(rotation.w()));
}

bool is_finite(const Rigid3& a_from_b) {
  return a_from_b.rotation.coeffs().allFinite() && a_from_b.translation.allFinite();
}

Rigid3 interpolate(const Rigid3& first, const Rigid3& second, double ratio) {
  return {first.rotation.slerp(ratio, second.rotation),
          (1.0 - ratio) * first.translation + ratio * second.translation};
}

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

}  // namespace samewhere::core
