#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <samewhere/verify/systematic_drift.hpp>

namespace samewhere::verify {
namespace {

// Columns: an error of 1 of distances, of turns, of the heading by distance and by time, and of
// rotation about each axis of the body by distance and by time.
constexpr int kErrors = 10;
using Effects = Eigen::Matrix<double, 3, kErrors>;

// How an edge moves and turns what comes after it, in the frame of the beginning.
struct EdgeEffects {
  Eigen::Vector3d pivot;  // the child, in the beginning
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
                       const core::Rigid3& begin_from_parent, double sign,
                       const SystematicDrift& drift) {
  const scene::OdometryEdge& edge = *child.odometry;
  const core::Rigid3 begin_from_child = begin_from_parent * edge.parent_from_keyframe;
  const Eigen::Matrix3d begin_from_child_axes = begin_from_child.rotation.toRotationMatrix();
  const double length_m = edge.parent_from_keyframe.translation.norm();
  const double duration_s = std::abs(child.view.stamp_s - map.at(edge.parent).view.stamp_s);
  Eigen::Vector3d axis = heading_axis(edge.information);
  const double tilt = axis.isZero() ? 1.0 : drift.tilt_ratio;
  // the direction of an eigenvector is arbitrary
  if (axis.sum() < 0.0) axis = -axis;
  EdgeEffects effects{begin_from_child.translation};
  effects.shift.col(0) =
      sign * drift.per_metre * (begin_from_parent.rotation * edge.parent_from_keyframe.translation);
  const auto turn = [&](const Eigen::Vector3d& turn_in_child) -> Eigen::Vector3d {
    return sign * (begin_from_child_axes * turn_in_child);
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

// Of the position, what a turn of a large heading error leaves out to first order.
double second_order_m(const std::vector<EdgeEffects>& edges, const Effects& turned,
                      const Eigen::Vector3d& end) {
  double reach_m = 0.0;
  for (const EdgeEffects& edge : edges) reach_m = std::max(reach_m, (end - edge.pivot).norm());
  return 0.5 * turned.squaredNorm() * reach_m;
}

}  // namespace

core::Matrix6d systematic_covariance(const scene::MapVersion& map,
                                     const std::vector<core::KeyframeId>& path,
                                     const SystematicDrift& drift) {
  if (drift.is_none()) return core::Matrix6d::Zero();
  std::vector<EdgeEffects> edges;
  core::Rigid3 begin_from_here;
  for (std::size_t i = path.size() - 1; i > 0; --i) {
    const bool is_down = is_child_of(map, path[i - 1], path[i]);
    const scene::Keyframe& child = map.at(is_down ? path[i - 1] : path[i]);
    const core::Rigid3& parent_from_child = child.odometry->parent_from_keyframe;
    const core::Rigid3 begin_from_next =
        begin_from_here * (is_down ? parent_from_child : inverse(parent_from_child));
    edges.push_back(effects_of(map, child, is_down ? begin_from_here : begin_from_next,
                               is_down ? 1.0 : -1.0, drift));
    begin_from_here = begin_from_next;
  }
  const Eigen::Vector3d end = begin_from_here.translation;
  Eigen::Matrix<double, 6, kErrors> by_error = Eigen::Matrix<double, 6, kErrors>::Zero();
  Effects turned = Effects::Zero();
  for (const EdgeEffects& edge : edges) {
    by_error.topRows<3>() += edge.shift - core::skew(end - edge.pivot) * edge.turn;
    turned += edge.turn;
  }
  by_error.bottomRows<3>() = begin_from_here.rotation.toRotationMatrix().transpose() * turned;
  core::Matrix6d covariance = by_error * by_error.transpose();
  const double rest_m = second_order_m(edges, turned, end);
  covariance.diagonal().head<3>().array() += rest_m * rest_m;
  return covariance;
}

}  // namespace samewhere::verify
