#include <algorithm>
#include <cmath>
#include <iterator>

#include <samewhere/input/transforms.hpp>

namespace samewhere::input {
namespace {

// Two frames that hang on each other would be followed for ever.
constexpr std::size_t kMaxDepth = 64;

std::string without_slash(const std::string& name) {
  return name.starts_with('/') ? name.substr(1) : name;
}

core::Rigid3 rigid_of(const messages::Vector3& translation, const messages::Quaternion& rotation) {
  return {.rotation = Eigen::Quaterniond(rotation.w, rotation.x, rotation.y, rotation.z),
          .translation = {translation.x, translation.y, translation.z}};
}

// Of quaternions that are none a message is not worth the end of a run.
bool is_pose(core::Rigid3& pose) {
  constexpr double kMaxDeviation = 0.1;
  if (!core::is_finite(pose) || std::abs(pose.rotation.norm() - 1.0) > kMaxDeviation) return false;
  pose.rotation.normalize();
  return true;
}

}  // namespace

core::Rigid3 rigid_of(const messages::Transform& transform) {
  return rigid_of(transform.translation, transform.rotation);
}

core::Rigid3 rigid_of(const messages::Pose& pose) {
  return rigid_of(pose.position, pose.orientation);
}

messages::Transform transform_of(const core::Rigid3& pose) {
  const auto& [rotation, translation] = pose;
  return {.translation = {translation.x(), translation.y(), translation.z()},
          .rotation = {rotation.x(), rotation.y(), rotation.z(), rotation.w()}};
}

void Transforms::add(const messages::TransformStamped& transform, bool is_static) {
  core::Rigid3 parent_from_child = rigid_of(transform.transform);
  if (!is_pose(parent_from_child)) return;
  const std::string parent = without_slash(transform.header.frame_id);
  const std::string child = without_slash(transform.child_frame_id);
  const auto [link, is_new] = links_.try_emplace(child, Link{parent, is_static, {}});
  if (!is_new && link->second.parent != parent) return;
  const std::int64_t stamp_ns = is_static ? 0 : messages::nanoseconds(transform.header.stamp);
  link->second.is_static = link->second.is_static && is_static;
  link->second.poses[stamp_ns] = parent_from_child;
}

std::vector<const Transforms::Link*> Transforms::way_up(const std::string& frame) const {
  std::vector<const Link*> way;
  auto link = links_.find(without_slash(frame));
  while (link != links_.end() && way.size() < kMaxDepth) {
    way.push_back(&link->second);
    link = links_.find(link->second.parent);
  }
  return way;
}

std::optional<core::Rigid3> Transforms::fixed(const std::string& target,
                                              const std::string& source) const {
  const std::string to = without_slash(target);
  const std::string from = without_slash(source);
  if (to == from) return core::Rigid3{};
  // poses of both in the frames above them, as far as all is fixed
  const auto poses_above = [this](const std::string& frame) {
    std::vector<std::pair<std::string, core::Rigid3>> above = {{frame, core::Rigid3{}}};
    for (const Link* link : way_up(frame)) {
      if (!link->is_static) break;
      above.emplace_back(link->parent, link->poses.begin()->second * above.back().second);
    }
    return above;
  };
  const auto above_source = poses_above(from);
  for (const auto& [frame, frame_from_target] : poses_above(to)) {
    const auto common =
        std::find_if(above_source.begin(), above_source.end(),
                     [&frame = frame](const auto& pose) { return pose.first == frame; });
    if (common != above_source.end()) return core::inverse(frame_from_target) * common->second;
  }
  return std::nullopt;
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
