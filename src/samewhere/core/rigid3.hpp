#pragma once

#include <Eigen/Geometry>

namespace samewhere::core {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// A rotation and a translation: x_in_a = a_from_b * x_in_b. Named a_from_b wherever it appears.
// Metres.
struct Rigid3 {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  static Rigid3 from_matrix(const Eigen::Matrix4d& a_from_b);
  Eigen::Matrix4d matrix() const;
};

// A rigid transform with a scale: x_in_a = scale * (rotation * x_in_b) + translation.
struct Sim3 {
  double scale = 1.0;
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  static Sim3 from_rigid(const Rigid3& a_from_b);
};

Rigid3 operator*(const Rigid3& a_from_b, const Rigid3& b_from_c);
Rigid3 inverse(const Rigid3& a_from_b);

// Here, as it is part of the innermost loops.
inline Eigen::Vector3d operator*(const Rigid3& a_from_b, const Eigen::Vector3d& x_in_b) {
  return a_from_b.rotation * x_in_b + a_from_b.translation;
}

Sim3 operator*(const Sim3& a_from_b, const Sim3& b_from_c);
Eigen::Vector3d operator*(const Sim3& a_from_b, const Eigen::Vector3d& x_in_b);
Sim3 inverse(const Sim3& a_from_b);
// Its rotation and translation; what is lost is the scale.
Rigid3 rigid_part(const Sim3& a_from_b);

// Tangent vectors are [translation (m); rotation (rad)]. exp_r3so3 is the retraction used by all
// solvers here: rotation by the exponential map of SO(3), translation as it stands (the product R^3
// x SO(3)).
Eigen::Quaterniond exp_so3(const Eigen::Vector3d& rotation_rad);
Eigen::Vector3d log_so3(const Eigen::Quaterniond& rotation);
Rigid3 exp_r3so3(const Vector6d& tangent);
Vector6d log_r3so3(const Rigid3& a_from_b);

// Angle of a rotation in [0, pi], radians.
double angle_rad(const Eigen::Quaterniond& rotation);
bool is_finite(const Rigid3& a_from_b);
// Between two poses: linear in translation, spherical in rotation; ratio 0 gives the first.
Rigid3 interpolate(const Rigid3& first, const Rigid3& second, double ratio);

Eigen::Matrix3d skew(const Eigen::Vector3d& v);

}  // namespace samewhere::core
