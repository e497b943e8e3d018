#include <Eigen/Eigenvalues>

#include <samewhere/verify/systematic_drift.hpp>

namespace samewhere::verify {
namespace {

// The axis of the largest rotation variance; zero if no variance stands out.
Eigen::Vector3d heading_axis(const core::Matrix6d& covariance) {
  constexpr double kMinRatio = 4.0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance.bottomRightCorner<3, 3>());
  const Eigen::Vector3d& variances = solver.eigenvalues();  // ascending
  if (variances(2) < kMinRatio * variances(1)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d axis = solver.eigenvectors().col(2);
  return axis.sum() < 0.0 ? Eigen::Vector3d(-axis) : axis;  // its direction is arbitrary
}

}  // namespace

ConstantErrors constant_errors(const core::Rigid3& parent, const core::Rigid3& child,
                               const core::Matrix6d& covariance, double duration_s,
                               const SystematicDrift& drift) {
  const Eigen::Matrix3d axes = child.rotation.toRotationMatrix();
  const Eigen::Vector3d step = child.translation - parent.translation;
  const double length_m = step.norm();
  const Eigen::Vector3d axis = heading_axis(covariance);
  const double tilt = axis.isZero() ? 1.0 : drift.tilt_ratio;
  ConstantErrors errors = ConstantErrors::Zero();
  auto turn = errors.bottomRows<3>();
  turn.col(1) =
      drift.rad_per_radian * (axes * core::log_so3(parent.rotation.conjugate() * child.rotation));
  turn.col(2) = drift.rad_per_metre * length_m * (axes * axis);
  turn.col(3) = drift.rad_per_s * duration_s * (axes * axis);
  turn.middleCols<3>(4) = drift.rad_per_metre * length_m * tilt * axes;
  turn.middleCols<3>(7) = drift.rad_per_s * duration_s * tilt * axes;
  errors.topRows<3>() = core::skew(child.translation) * turn;
  errors.col(0).head<3>() = drift.per_metre * step;
  return errors;
}

}  // namespace samewhere::verify
