#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/core/truth.hpp>
#include <samewhere/messages/messages.hpp>

namespace samewhere::input {

// The name of a frame as TF 2 has it. In ROS 1 it may begin with a slash, which means the same.
std::string frame_name(const std::string& name);

// Nothing for what is no rigid transform: a number is not finite, or the length of the quaternion
// is not 1, within 10 %.
std::optional<core::Rigid3> rigid_from(const messages::Vector3& translation,
                                       const messages::Quaternion& rotation);
messages::Transform transform_of(const core::Rigid3& pose);

// A tree of frames: which hangs on which, fixed (/tf_static) or moving (/tf). Names with and
// without a leading slash are the same.
class Transforms {
 public:
  // A later fixed transform of a frame replaces the earlier one. A frame that moves keeps its first
  // parent. Returns false for a transform that is not usable and left out: it is not rigid, has no
  // names, closes a ring, or would give a moving frame another parent.
  bool add(const messages::TransformStamped& transform, bool is_static);

  // The frame at the top of those that are fixed to `frame`: itself, if it hangs on none.
  struct Root {
    std::string name;
    core::Rigid3 root_from_frame;
  };
  Root fixed_root_of(const std::string& frame) const;
  // target_from_source where all frames on the way are fixed to each other. Nothing: they are not,
  // or are not known.
  std::optional<core::Rigid3> fixed(const std::string& target, const std::string& source) const;
  // root_from_frame at the moments of the moving transform on the way from the frame to its root
  // that has the most; the others are interpolated. Empty: nothing on the way moves.
  core::Trajectory trajectory_of(const std::string& frame) const;

 private:
  struct Link {
    std::string parent;
    bool is_static = true;
    std::map<std::int64_t, core::Rigid3> poses;  // parent_from_child, by stamps in nanoseconds
  };
  // From the frame up.
  std::vector<const Link*> way_up(const std::string& frame) const;
  bool is_at_or_above(const std::string& frame, std::string below) const;
  static std::optional<core::Rigid3> pose_at(const Link& link, std::int64_t stamp_ns);

  std::map<std::string, Link> links_;  // by the child; without rings
};

}  // namespace samewhere::input
