#pragma once

#include <samewhere/core/rigid3.hpp>

namespace samewhere::optimize {

// The step that all solvers take on R^3 x SO(3): tangent = [translation (m); rotation (rad)], the
// rotation on the left.
core::Rigid3 retract(const core::Rigid3& a_from_b, const core::Vector6d& tangent);

// Inverse of the right Jacobian of SO(3): log(exp(r) exp(d)) = r + right_jacobian_inverse(r) d +
// O(d^2).
Eigen::Matrix3d right_jacobian_inverse(const Eigen::Vector3d& rotation_rad);

// The root U of an information matrix (symmetric, positive definite): |U r|^2 = r' information r.
// Throws ContractError if the matrix has none.
core::Matrix6d whitening(const core::Matrix6d& information);

}  // namespace samewhere::optimize
