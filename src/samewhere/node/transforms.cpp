#include <samewhere/input/transforms.hpp>
#include <samewhere/library/convert.hpp>
#include <samewhere/node/transforms.hpp>

namespace samewhere::node {

std::optional<Pose> pose_from(const messages::Vector3& position,
                              const messages::Quaternion& rotation) {
  const auto pose = input::rigid_from(position, rotation);
  if (!pose) return std::nullopt;
  return library::pose_of(*pose);
}

messages::Pose pose_message(const Pose& pose) {
  const messages::Transform transform = input::transform_of(library::rigid_of(pose));
  return {.position = transform.translation, .orientation = transform.rotation};
}

messages::TransformStamped transform_message(const std::string& parent, const std::string& child,
                                             double stamp_s, const Pose& parent_from_child) {
  return {.header = {.stamp = messages::time_of(stamp_s), .frame_id = parent},
          .child_frame_id = child,
          .transform = input::transform_of(library::rigid_of(parent_from_child))};
}

Pose body_from_optical() {
  Pose pose = Pose::Identity();
  pose.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return pose;
}

}  // namespace samewhere::node
