#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include <samewhere/messages/messages.hpp>
#include <samewhere/types.hpp>

namespace samewhere::node {

// Poses to and from messages. Of what is no rigid pose (not finite, quaternion of length 0):
// nothing.
std::optional<Pose> pose_from(const messages::Vector3& position,
                              const messages::Quaternion& rotation);
messages::Pose pose_message(const Pose& pose);
messages::TransformStamped transform_message(const std::string& parent, const std::string& child,
                                             double stamp_s, const Pose& parent_from_child);

// ROS 1 has names of frames that begin with a slash; they mean the same without.
std::string frame_name(const std::string& name);

// Axes of a robot (x forward, y left, z up; REP-103) at the centre of a camera (z forward, x right,
// y down).
Pose body_from_optical();

// The transforms of /tf_static: a tree of frames. A later transform of a frame replaces the earlier
// one.
class StaticTransforms {
 public:
  struct Root {
    std::string name;
    Pose root_from_frame = Pose::Identity();
  };

  // Returns how many transforms are not usable; they are left out.
  int take(const messages::TFMessage& message);
  // The frame at the top of the tree that holds `frame`: itself, if it has no parent.
  Root root_of(const std::string& frame) const;
  // Nothing if the two are not connected.
  std::optional<Pose> find(const std::string& target, const std::string& source) const;

 private:
  struct Link {
    std::string parent;
    Pose parent_from_child = Pose::Identity();
  };
  // A link from `frame` up to `below` would close a ring.
  bool is_at_or_above(const std::string& frame, std::string below) const;

  std::map<std::string, Link> links_;  // by child
};

}  // namespace samewhere::node
