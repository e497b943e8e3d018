#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <samewhere/report/plan_view.hpp>

namespace samewhere::report {
namespace {

// An axis has no sign: take the one whose largest coordinate is positive.
Eigen::Vector3d with_fixed_sign(const Eigen::Vector3d& axis) {
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0.0 ? Eigen::Vector3d(-axis) : axis;
}

}  // namespace

PlanView plan_view_of(const std::vector<core::Rigid3>& poses) {
  PlanView view;
  if (poses.empty()) return view;
  const double count = static_cast<double>(poses.size());
  Eigen::Vector3d sum_of_ups = Eigen::Vector3d::Zero();
  for (const core::Rigid3& world_from_camera : poses) {
    view.centre += world_from_camera.translation / count;
    sum_of_ups -= world_from_camera.rotation * Eigen::Vector3d::UnitY();
  }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const core::Rigid3& world_from_camera : poses) {
    const Eigen::Vector3d offset = world_from_camera.translation - view.centre;
    covariance += offset * offset.transpose() / count;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);  // ascending
  view.right = with_fixed_sign(axes.eigenvectors().col(2));
  view.up = with_fixed_sign(axes.eigenvectors().col(1));
  const Eigen::Vector3d towards_viewer = view.right.cross(view.up);
  if (towards_viewer.dot(sum_of_ups) < 0.0) view.up = -view.up;

  constexpr double kMinCosine = 0.7;  // looking down within 45 degrees
  view.is_from_above = std::abs(towards_viewer.dot(sum_of_ups)) > kMinCosine * sum_of_ups.norm();
  return view;
}

Eigen::Vector2d seen(const PlanView& view, const Eigen::Vector3d& in_world) {
  const Eigen::Vector3d offset = in_world - view.centre;
  return {offset.dot(view.right), offset.dot(view.up)};
}

}  // namespace samewhere::report
