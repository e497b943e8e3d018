#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <samewhere/verify/systematic_drift.hpp>

namespace samewhere::verify {
namespace {

using Effects = DriftSum::Effects;

// How an edge moves and turns what comes after it, in the frame of the end.
struct EdgeEffects {
  Eigen::Vector3d pivot;  // the child, in the end
  Effects shift = Effects::Zero();
  Effects turn = Effects::Zero();
};

// The axis of the largest rotation variance; zero if no variance stands out.
Eigen::Vector3d heading_axis(const core::Matrix6d& information) {
  constexpr double kMinRatio = 4.0;
  const core::Matrix6d covariance = information.inverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance.bottomRightCorner<3, 3>());
  const Eigen::Vector3d& variances = solver.eigenvalues();  // ascending
  if (variances(2) < kMinRatio * variances(1)) return Eigen::Vector3d::Zero();
  return solver.eigenvectors().col(2);
}

// `sign`: 1 if the path goes from the parent to the child.
EdgeEffects effects_of(const scene::MapVersion& map, const scene::Keyframe& child,
                       const core::Rigid3& end_from_parent, double sign,
                       const SystematicDrift& drift) {
  const scene::OdometryEdge& edge = *child.odometry;
  const core::Rigid3 end_from_child = end_from_parent * edge.parent_from_keyframe;
  const Eigen::Matrix3d end_from_child_axes = end_from_child.rotation.toRotationMatrix();
  const double length_m = edge.parent_from_keyframe.translation.norm();
  const double duration_s = std::abs(child.view.stamp_s - map.at(edge.parent).view.stamp_s);
  Eigen::Vector3d axis = heading_axis(edge.information);
  const double tilt = axis.isZero() ? 1.0 : drift.tilt_ratio;
  // the direction of an eigenvector is arbitrary
  if (axis.sum() < 0.0) axis = -axis;
  EdgeEffects effects{end_from_child.translation};
  effects.shift.col(0) =
      sign * drift.per_metre * (end_from_parent.rotation * edge.parent_from_keyframe.translation);
  const auto turn = [&](const Eigen::Vector3d& turn_in_child) -> Eigen::Vector3d {
    return sign * (end_from_child_axes * turn_in_child);
  };
  effects.turn.col(1) =
      turn(drift.rad_per_radian * core::log_so3(edge.parent_from_keyframe.rotation));
  effects.turn.col(2) = turn(drift.rad_per_metre * length_m * axis);
  effects.turn.col(3) = turn(drift.rad_per_s * duration_s * axis);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d about = tilt * Eigen::Vector3d::Unit(i);
    effects.turn.col(4 + i) = turn(drift.rad_per_metre * length_m * about);
    effects.turn.col(7 + i) = turn(drift.rad_per_s * duration_s * about);
  }
  return effects;
}

bool is_child_of(const scene::MapVersion& map, core::KeyframeId child, core::KeyframeId parent) {
  const auto& odometry = map.at(child).odometry;
  return odometry && odometry->parent == parent;
}

}  // namespace

void DriftSum::lengthen(const scene::MapVersion& map, core::KeyframeId here,
                        core::KeyframeId before) {
  if (drift_.is_none()) return;
  const bool is_down = is_child_of(map, here, before);
  const scene::Keyframe& child = map.at(is_down ? here : before);
  const core::Rigid3& parent_from_child = child.odometry->parent_from_keyframe;
  const core::Rigid3 end_from_before =
      end_from_begin_ * (is_down ? inverse(parent_from_child) : parent_from_child);
  const EdgeEffects edge = effects_of(map, child, is_down ? end_from_before : end_from_begin_,
                                      is_down ? 1.0 : -1.0, drift_);
  shift_ += edge.shift + core::skew(edge.pivot) * edge.turn;
  turn_ += edge.turn;
  reach_m_ = std::max(reach_m_, edge.pivot.norm());
  end_from_begin_ = end_from_before;
}

core::Matrix6d DriftSum::covariance() const {
  if (drift_.is_none()) return core::Matrix6d::Zero();
  Eigen::Matrix<double, 6, kErrors> by_error;
  by_error.topRows<3>() = end_from_begin_.rotation.conjugate().toRotationMatrix() * shift_;
  by_error.bottomRows<3>() = turn_;
  core::Matrix6d covariance = by_error * by_error.transpose();
  // what a turn of a large heading error leaves out to first order
  const double rest_m = 0.5 * turn_.squaredNorm() * reach_m_;
  covariance.diagonal().head<3>().array() += rest_m * rest_m;
  return covariance;
}

core::Matrix6d systematic_covariance(const scene::MapVersion& map,
                                     const std::vector<core::KeyframeId>& path,
                                     const SystematicDrift& drift) {
  DriftSum sum(drift);
  for (std::size_t i = 1; i < path.size(); ++i) sum.lengthen(map, path[i - 1], path[i]);
  return sum.covariance();
}

}  // namespace samewhere::verify
