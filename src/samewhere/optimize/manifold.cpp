#include <cmath>

#include <Eigen/Cholesky>

#include <samewhere/core/errors.hpp>
#include <samewhere/optimize/manifold.hpp>

namespace samewhere::optimize {

core::Rigid3 retract(const core::Rigid3& a_from_b, const core::Vector6d& tangent) {
  return {(core::exp_so3(tangent.tail<3>()) * a_from_b.rotation).normalized(),
          a_from_b.translation + tangent.head<3>()};
}

Eigen::Matrix3d right_jacobian_inverse(const Eigen::Vector3d& rotation_rad) {
  const Eigen::Matrix3d r = core::skew(rotation_rad);
  const double angle = rotation_rad.norm();
  // (1 / a^2 - (1 + cos a) / (2 a sin a)); its limit where it loses digits
  const double k = angle < 1e-4 ? 1.0 / 12.0
                                : 1.0 / (angle * angle) -
                                      (1.0 + std::cos(angle)) / (2.0 * angle * std::sin(angle));
  return Eigen::Matrix3d::Identity() + 0.5 * r + k * r * r;
}

core::Matrix6d whitening(const core::Matrix6d& information) {
  const Eigen::LLT<core::Matrix6d> factor(information);
  core::require(factor.info() == Eigen::Success, "an information matrix is positive definite");
  return factor.matrixU();
}

}  // namespace samewhere::optimize
