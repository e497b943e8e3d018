#pragma once

#include <optional>
#include <string>

#include <samewhere/messages/messages.hpp>
#include <samewhere/types.hpp>

namespace samewhere::node {

// Poses to and from messages, as input/transforms.hpp has them.
std::optional<Pose> pose_from(const messages::Vector3& position,
                              const messages::Quaternion& rotation);
messages::Pose pose_message(const Pose& pose);
messages::TransformStamped transform_message(const std::string& parent, const std::string& child,
                                             double stamp_s, const Pose& parent_from_child);

// Axes of a robot (x forward, y left, z up; REP-103) at the centre of a camera (z forward, x right,
// y down).
Pose body_from_optical();

}  // namespace samewhere::node
