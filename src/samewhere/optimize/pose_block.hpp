#pragma once

// For the files of this folder that call Ceres: how a pose is a parameter block.

#include <algorithm>
#include <array>

#include <ceres/ceres.h>

#include <samewhere/optimize/manifold.hpp>

namespace samewhere::optimize {

inline constexpr std::size_t kPoseSize = 7;
inline constexpr std::size_t kPointSize = 3;

using PoseBlock = std::array<double, kPoseSize>;  // qx qy qz qw tx ty tz

inline PoseBlock to_block(const core::Rigid3& pose) {
  const auto& q = pose.rotation;
  const auto& t = pose.translation;
  return {q.x(), q.y(), q.z(), q.w(), t.x(), t.y(), t.z()};
}

inline core::Rigid3 from_block(const double* block) {
  return {Eigen::Quaterniond(block[3], block[0], block[1], block[2]),
          {block[4], block[5], block[6]}};
}

// retract() for Ceres. Its Jacobian is declared as [I; 0], and cost functions put the derivative by
// the tangent into the first six columns (write_by_tangent): Ceres only ever uses the product of
// the two, and no derivative by a quaternion is needed.
class PoseManifold : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }

  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    const PoseBlock moved =
        to_block(retract(from_block(x), Eigen::Map<const core::Vector6d>(delta)));
    std::copy(moved.begin(), moved.end(), x_plus_delta);
    return true;
  }

  bool PlusJacobian(const double* /*x*/, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }

  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    const core::Rigid3 to = from_block(y);
    const core::Rigid3 from = from_block(x);
    Eigen::Map<core::Vector6d> difference(y_minus_x);
    difference << to.translation - from.translation,
        core::log_so3(to.rotation * from.rotation.conjugate());
    return true;
  }

  bool MinusJacobian(const double* /*x*/, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
};

// The derivative by the tangent as PoseManifold expects it; nothing if Ceres did not ask for it.
template <int Rows>
void write_by_tangent(const Eigen::Matrix<double, Rows, 6>& by_tangent, double* out) {
  if (out == nullptr) return;
  Eigen::Map<Eigen::Matrix<double, Rows, 7, Eigen::RowMajor>> ambient(out);
  ambient.template leftCols<6>() = by_tangent;
  ambient.col(6).setZero();
}

}  // namespace samewhere::optimize
