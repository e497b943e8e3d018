#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include <samewhere/core/errors.hpp>
#include <samewhere/verify/odometry_tree.hpp>

namespace samewhere::verify {
namespace {

bool is_same(const scene::OdometryEdge& a, const scene::OdometryEdge& b) {
  return a.parent == b.parent &&
         a.parent_from_keyframe.translation == b.parent_from_keyframe.translation &&
         a.parent_from_keyframe.rotation.coeffs() == b.parent_from_keyframe.rotation.coeffs() &&
         a.information == b.information;
}

// From a twist about the origin to what it makes of the end: [position in the beginning; rotation
// in the end].
core::Matrix6d end_by_twist(const core::Rigid3& origin_from_begin,
                            const core::Rigid3& origin_from_end) {
  const Eigen::Matrix3d to_begin = origin_from_begin.rotation.conjugate().toRotationMatrix();
  core::Matrix6d by_twist = core::Matrix6d::Zero();
  by_twist.topLeftCorner<3, 3>() = to_begin;
  by_twist.topRightCorner<3, 3>() = -to_begin * core::skew(origin_from_end.translation);
  by_twist.bottomRightCorner<3, 3>() = origin_from_end.rotation.conjugate().toRotationMatrix();
  return by_twist;
}

}  // namespace

void OdometryTree::follow(const scene::MapVersion& map) {
  std::size_t num_known = 0;
  while (num_known < std::min(nodes_.size(), map.keyframes.size()) &&
         is_known(map.keyframes[num_known]))
    ++num_known;
  nodes_.resize(num_known);
  constant_errors_.resize(bias_.is_none() ? 0 : num_known);
  reaches_.clear();
  for (std::size_t i = num_known; i < map.keyframes.size(); ++i) add(map, map.keyframes[i]);
}

bool OdometryTree::is_known(const scene::Keyframe& keyframe) const {
  const auto& edge = at(keyframe.id).edge;
  if (!edge || !keyframe.odometry) return !edge && !keyframe.odometry;
  return is_same(*edge, *keyframe.odometry);
}

void OdometryTree::add(const scene::MapVersion& map, const scene::Keyframe& keyframe) {
  Node node{.origin = keyframe.id, .edge = keyframe.odometry};
  ConstantErrors constant = ConstantErrors::Zero();
  if (keyframe.odometry) {
    const core::KeyframeId id = keyframe.odometry->parent;
    const Node& parent = at(id);
    node.origin = parent.origin;
    node.depth = parent.depth + 1;
    node.origin_from_keyframe =
        parent.origin_from_keyframe * keyframe.odometry->parent_from_keyframe;
    node.edge_covariance = keyframe.odometry->information.inverse();
    // the position of an edge's error is in its parent, the rotation in its child
    core::Matrix6d twist = core::Matrix6d::Zero();
    const Eigen::Matrix3d axes = node.origin_from_keyframe.rotation.toRotationMatrix();
    twist.topLeftCorner<3, 3>() = parent.origin_from_keyframe.rotation.toRotationMatrix();
    twist.topRightCorner<3, 3>() = core::skew(node.origin_from_keyframe.translation) * axes;
    twist.bottomRightCorner<3, 3>() = axes;
    node.twist_covariance =
        parent.twist_covariance + twist * node.edge_covariance * twist.transpose();
    if (!bias_.is_none()) {
      const double duration_s = std::abs(keyframe.view.stamp_s - map.at(id).view.stamp_s);
      constant = constant_errors_[id.index()] +
                 constant_errors(parent.origin_from_keyframe, node.origin_from_keyframe,
                                 node.edge_covariance, duration_s, bias_);
    }
  }
  nodes_.push_back(std::move(node));
  if (!bias_.is_none()) constant_errors_.push_back(constant);
}

std::optional<geometry::UncertainPose> OdometryTree::between(core::KeyframeId begin,
                                                             core::KeyframeId end) {
  const auto ancestor = common_ancestor(begin, end);
  if (!ancestor) return std::nullopt;
  return geometry::UncertainPose{
      inverse(at(begin).origin_from_keyframe) * at(end).origin_from_keyframe,
      random_covariance(begin, end, *ancestor) + constant_covariance(begin, end, *ancestor)};
}

core::Matrix6d OdometryTree::systematic_covariance(core::KeyframeId begin, core::KeyframeId end) {
  const auto ancestor = common_ancestor(begin, end);
  core::require(ancestor.has_value(), "odometry joins the two keyframes");
  return constant_covariance(begin, end, *ancestor);
}

core::Matrix6d OdometryTree::random_covariance(core::KeyframeId begin, core::KeyframeId end,
                                               core::KeyframeId ancestor) const {
  // what moves the beginning moves the end back in its frame
  const core::Matrix6d twists = (at(end).twist_covariance - at(ancestor).twist_covariance) +
                                (at(begin).twist_covariance - at(ancestor).twist_covariance);
  const core::Matrix6d by_twist =
      end_by_twist(at(begin).origin_from_keyframe, at(end).origin_from_keyframe);
  return by_twist * twists * by_twist.transpose();
}

core::Matrix6d OdometryTree::constant_covariance(core::KeyframeId begin, core::KeyframeId end,
                                                 core::KeyframeId ancestor) {
  if (bias_.is_none()) return core::Matrix6d::Zero();
  const ConstantErrors by_error =
      end_by_twist(at(begin).origin_from_keyframe, at(end).origin_from_keyframe) *
      (constant_errors_[end.index()] - constant_errors_[begin.index()]);
  core::Matrix6d covariance = by_error * by_error.transpose();
  // what a turn of a large heading error leaves out to first order
  const double rest_m =
      0.5 * by_error.bottomRows<3>().squaredNorm() * reach_m(begin, end, ancestor);
  covariance.diagonal().head<3>().array() += rest_m * rest_m;
  return covariance;
}

double OdometryTree::reach_m(core::KeyframeId begin, core::KeyframeId end,
                             core::KeyframeId ancestor) {
  const Eigen::Vector3d& from = at(end).origin_from_keyframe.translation;
  const auto distance_m = [&](core::KeyframeId keyframe) {
    return (at(keyframe).origin_from_keyframe.translation - from).norm();
  };
  Reach& reach = reaches_.try_emplace(end, Reach{.next = end}).first->second;
  const std::size_t num_edges = at(end).depth - at(ancestor).depth;
  while (reach.after_edges_m.size() <= num_edges) {
    reach.after_edges_m.push_back(std::max(reach.after_edges_m.back(), distance_m(reach.next)));
    reach.next = at(reach.next).edge->parent;
  }
  double farthest_m = reach.after_edges_m[num_edges];
  for (core::KeyframeId child = begin; child != ancestor; child = at(child).edge->parent)
    farthest_m = std::max(farthest_m, distance_m(child));
  return farthest_m;
}

std::optional<core::KeyframeId> OdometryTree::parent(core::KeyframeId keyframe) const {
  const auto& edge = at(keyframe).edge;
  return edge ? std::optional(edge->parent) : std::nullopt;
}

// Keyframes are older than their children.
std::optional<core::KeyframeId> OdometryTree::common_ancestor(core::KeyframeId a,
                                                              core::KeyframeId b) const {
  if (at(a).origin != at(b).origin) return std::nullopt;
  while (a != b) {
    core::KeyframeId& younger = a > b ? a : b;
    younger = at(younger).edge->parent;
  }
  return a;
}

std::vector<core::KeyframeId> OdometryTree::path(core::KeyframeId begin,
                                                 core::KeyframeId end) const {
  const auto ancestor = common_ancestor(begin, end);
  if (!ancestor) return {};
  std::vector<core::KeyframeId> path;
  for (core::KeyframeId up = end; up != *ancestor; up = at(up).edge->parent) path.push_back(up);
  path.push_back(*ancestor);
  const auto top = static_cast<std::ptrdiff_t>(path.size());
  for (core::KeyframeId up = begin; up != *ancestor; up = at(up).edge->parent) path.push_back(up);
  std::reverse(path.begin() + top, path.end());
  return path;
}

}  // namespace samewhere::verify
