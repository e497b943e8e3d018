#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <samewhere/report/upright.hpp>

namespace samewhere::report {
namespace {

// Least share of the second direction in the x axes of the cameras, for their plane to be known: a
// heading that varies by about 20 degrees.
constexpr double kMinSecondShare = 0.03;

// An axis has no sign: take the one whose largest coordinate is positive.
Eigen::Vector3d with_largest_positive(const Eigen::Vector3d& axis) {
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0.0 ? Eigen::Vector3d(-axis) : axis;
}

Eigen::Vector3d up_of(const std::vector<core::Rigid3>& poses) {
  Eigen::Vector3d sum_of_ups = Eigen::Vector3d::Zero();
  Eigen::Matrix3d of_x_axes = Eigen::Matrix3d::Zero();
  for (const core::Rigid3& world_from_camera : poses) {
    sum_of_ups -= world_from_camera.rotation * Eigen::Vector3d::UnitY();
    const Eigen::Vector3d x_axis = world_from_camera.rotation * Eigen::Vector3d::UnitX();
    of_x_axes += x_axis * x_axis.transpose() / static_cast<double>(poses.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(of_x_axes);  // ascending
  if (axes.eigenvalues()[1] < kMinSecondShare) {
    const Eigen::Vector3d x_axis = axes.eigenvectors().col(2);
    const Eigen::Vector3d up = sum_of_ups - sum_of_ups.dot(x_axis) * x_axis;
    return up.norm() > 0.0 ? Eigen::Vector3d(up.normalized()) : x_axis.unitOrthogonal();
  }
  const Eigen::Vector3d up = axes.eigenvectors().col(0);
  return up.dot(sum_of_ups) < 0.0 ? Eigen::Vector3d(-up) : up;
}

}  // namespace

Upright upright_of(const std::vector<core::Rigid3>& poses) {
  Upright upright;
  if (poses.empty()) return upright;
  upright.up = up_of(poses);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const core::Rigid3& pose : poses) centre += pose.translation / double(poses.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const core::Rigid3& pose : poses) {
    Eigen::Vector3d offset = pose.translation - centre;
    offset -= offset.dot(upright.up) * upright.up;
    covariance += offset * offset.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
  Eigen::Vector3d right = with_largest_positive(axes.eigenvectors().col(2));
  right -= right.dot(upright.up) * upright.up;  // a camera that stands still gives any axis
  upright.right = right.norm() > 0.5 ? Eigen::Vector3d(right.normalized())
                                     : Eigen::Vector3d(upright.up.unitOrthogonal());
  return upright;
}

}  // namespace samewhere::report
