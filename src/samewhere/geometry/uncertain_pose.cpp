#include <samewhere/geometry/uncertain_pose.hpp>

namespace samewhere::geometry {

UncertainPose compose(const UncertainPose& a_from_b, const UncertainPose& b_from_c) {
  const Eigen::Matrix3d rotation_a_b = a_from_b.a_from_b.rotation.toRotationMatrix();
  const Eigen::Matrix3d rotation_b_c = b_from_c.a_from_b.rotation.toRotationMatrix();
  // t = R_ab t_bc + t_ab and R = R_ab R_bc, each disturbed to first order
  core::Matrix6d by_first = core::Matrix6d::Identity();
  by_first.topRightCorner<3, 3>() = -rotation_a_b * core::skew(b_from_c.a_from_b.translation);
  by_first.bottomRightCorner<3, 3>() = rotation_b_c.transpose();
  core::Matrix6d by_second = core::Matrix6d::Identity();
  by_second.topLeftCorner<3, 3>() = rotation_a_b;
  return {a_from_b.a_from_b * b_from_c.a_from_b,
          by_first * a_from_b.covariance * by_first.transpose() +
              by_second * b_from_c.covariance * by_second.transpose()};
}

UncertainPose inverse(const UncertainPose& a_from_b) {
  const core::Rigid3 b_from_a = inverse(a_from_b.a_from_b);
  const Eigen::Matrix3d rotation_a_b = a_from_b.a_from_b.rotation.toRotationMatrix();
  // t' = -R' t and R' = R^T: an error of R on the right stands on the left of R', and moves t' with
  // it
  core::Matrix6d by_pose = core::Matrix6d::Zero();
  by_pose.topLeftCorner<3, 3>() = -rotation_a_b.transpose();
  by_pose.topRightCorner<3, 3>() =
      -core::skew(rotation_a_b.transpose() * a_from_b.a_from_b.translation);
  by_pose.bottomRightCorner<3, 3>() = -rotation_a_b;
  return {b_from_a, by_pose * a_from_b.covariance * by_pose.transpose()};
}

}  // namespace samewhere::geometry
