#include <cmath>
#include <iterator>
#include <utility>

#include <samewhere/input/transforms.hpp>

namespace samewhere::input {

std::string frame_name(const std::string& name) {
  return name.starts_with('/') ? name.substr(1) : name;
}

std::optional<core::Rigid3> rigid_from(const messages::Vector3& translation,
                                       const messages::Quaternion& rotation) {
  constexpr double kMaxDeviationOfLength = 0.1;
  core::Rigid3 pose{.rotation = {rotation.w, rotation.x, rotation.y, rotation.z},
                    .translation = {translation.x, translation.y, translation.z}};
  if (!core::is_finite(pose) || std::abs(pose.rotation.norm() - 1.0) > kMaxDeviationOfLength)
    return std::nullopt;
  pose.rotation.normalize();
  return pose;
}

messages::Transform transform_of(const core::Rigid3& pose) {
  const auto& [rotation, translation] = pose;
  return {.translation = {translation.x(), translation.y(), translation.z()},
          .rotation = {rotation.x(), rotation.y(), rotation.z(), rotation.w()}};
}

bool Transforms::add(const messages::TransformStamped& transform, bool is_static) {
  const std::string parent = frame_name(transform.header.frame_id);
  const std::string child = frame_name(transform.child_frame_id);
  const auto pose = rigid_from(transform.transform.translation, transform.transform.rotation);
  if (!pose || parent.empty() || child.empty() || is_at_or_above(child, parent)) return false;
  const auto [known, is_new] = links_.try_emplace(child, Link{parent, is_static, {}});
  Link& link = known->second;
  if (is_static && !link.is_static) return false;
  if (is_static) {
    link = {parent, true, {{0, *pose}}};
    return true;
  }
  if (link.parent != parent) return false;
  if (link.is_static) link = {parent, false, {}};
  link.poses[messages::nanoseconds(transform.header.stamp)] = *pose;
  return true;
}

bool Transforms::is_at_or_above(const std::string& frame, std::string below) const {
  while (below != frame) {
    const auto link = links_.find(below);
    if (link == links_.end()) return false;
    below = link->second.parent;
  }
  return true;
}

std::vector<const Transforms::Link*> Transforms::way_up(const std::string& frame) const {
  std::vector<const Link*> way;
  for (auto link = links_.find(frame_name(frame)); link != links_.end();
       link = links_.find(link->second.parent))
    way.push_back(&link->second);
  return way;
}

Transforms::Root Transforms::fixed_root_of(const std::string& frame) const {
  Root root{.name = frame_name(frame), .root_from_frame = {}};
  for (const Link* link : way_up(frame)) {
    if (!link->is_static) break;
    root.name = link->parent;
    root.root_from_frame = link->poses.begin()->second * root.root_from_frame;
  }
  return root;
}

std::optional<core::Rigid3> Transforms::fixed(const std::string& target,
                                              const std::string& source) const {
  if (frame_name(target) == frame_name(source)) return core::Rigid3{};
  const Root of_target = fixed_root_of(target);
  const Root of_source = fixed_root_of(source);
  if (of_target.name != of_source.name) return std::nullopt;
  return core::inverse(of_target.root_from_frame) * of_source.root_from_frame;
}

std::optional<core::Rigid3> Transforms::pose_at(const Link& link, std::int64_t stamp_ns) {
  if (link.is_static) return link.poses.begin()->second;
  const auto after = link.poses.lower_bound(stamp_ns);
  if (after == link.poses.end()) return std::nullopt;
  if (after->first == stamp_ns) return after->second;
  if (after == link.poses.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const double ratio = static_cast<double>(stamp_ns - before->first) /
                       static_cast<double>(after->first - before->first);
  return core::interpolate(before->second, after->second, ratio);
}

core::Trajectory Transforms::trajectory_of(const std::string& frame) const {
  const std::vector<const Link*> way = way_up(frame);
  const Link* leading = nullptr;
  for (const Link* link : way) {
    if (!link->is_static && (leading == nullptr || link->poses.size() > leading->poses.size()))
      leading = link;
  }
  core::Trajectory trajectory;
  if (leading == nullptr) return trajectory;
  for (const auto& [stamp_ns, unused] : leading->poses) {
    core::Rigid3 root_from_frame;
    bool is_known = true;
    for (const Link* link : way) {
      const auto pose = pose_at(*link, stamp_ns);
      is_known = is_known && pose.has_value();
      if (pose) root_from_frame = *pose * root_from_frame;
    }
    if (is_known)
      trajectory.push_back(
          {messages::seconds(messages::time_of_nanoseconds(stamp_ns)), root_from_frame});
  }
  return trajectory;
}

}  // namespace samewhere::input
