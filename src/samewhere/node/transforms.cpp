#include <cmath>

#include <samewhere/node/transforms.hpp>

namespace samewhere::node {

std::optional<Pose> pose_from(const messages::Vector3& position,
                              const messages::Quaternion& rotation) {
  const Eigen::Quaterniond q(rotation.w, rotation.x, rotation.y, rotation.z);
  const Eigen::Vector3d t(position.x, position.y, position.z);
  constexpr double kLeastNorm = 1e-6;
  if (!t.allFinite() || !q.coeffs().allFinite() || !(q.norm() > kLeastNorm)) return std::nullopt;
  Pose pose = Pose::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = t;
  return pose;
}

messages::Pose pose_message(const Pose& pose) {
  const Eigen::Vector3d& t = pose.translation();
  const Eigen::Quaterniond q = Eigen::Quaterniond(pose.linear()).normalized();
  return {.position = {t.x(), t.y(), t.z()}, .orientation = {q.x(), q.y(), q.z(), q.w()}};
}

messages::TransformStamped transform_message(const std::string& parent, const std::string& child,
                                             double stamp_s, const Pose& parent_from_child) {
  const messages::Pose pose = pose_message(parent_from_child);
  return {.header = {.stamp = messages::time_of(stamp_s), .frame_id = parent},
          .child_frame_id = child,
          .transform = {.translation = pose.position, .rotation = pose.orientation}};
}

std::string frame_name(const std::string& name) {
  return name.starts_with('/') ? name.substr(1) : name;
}

Pose body_from_optical() {
  Pose pose = Pose::Identity();
  pose.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return pose;
}

int StaticTransforms::take(const messages::TFMessage& message) {
  int num_unusable = 0;
  for (const messages::TransformStamped& transform : message.transforms) {
    const std::string parent = frame_name(transform.header.frame_id);
    const std::string child = frame_name(transform.child_frame_id);
    const auto pose = pose_from(transform.transform.translation, transform.transform.rotation);
    if (!pose || parent.empty() || child.empty() || is_at_or_above(child, parent)) {
      ++num_unusable;
      continue;
    }
    links_[child] = {parent, *pose};
  }
  return num_unusable;
}

bool StaticTransforms::is_at_or_above(const std::string& frame, std::string below) const {
  while (below != frame) {
    const auto link = links_.find(below);
    if (link == links_.end()) return false;
    below = link->second.parent;
  }
  return true;
}

StaticTransforms::Root StaticTransforms::root_of(const std::string& frame) const {
  Root root{.name = frame};
  for (auto link = links_.find(frame); link != links_.end(); link = links_.find(root.name)) {
    root.name = link->second.parent;
    root.root_from_frame = link->second.parent_from_child * root.root_from_frame;
  }
  return root;
}

std::optional<Pose> StaticTransforms::find(const std::string& target,
                                           const std::string& source) const {
  const Root of_target = root_of(target);
  const Root of_source = root_of(source);
  if (of_target.name != of_source.name) return std::nullopt;
  return of_target.root_from_frame.inverse() * of_source.root_from_frame;
}

}  // namespace samewhere::node
