#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/core/truth.hpp>
#include <samewhere/messages/messages.hpp>

namespace samewhere::input {

core::Rigid3 rigid_of(const messages::Transform& transform);
core::Rigid3 rigid_of(const messages::Pose& pose);
messages::Transform transform_of(const core::Rigid3& pose);

// The frames of a recording: which hangs on which, fixed (/tf_static) or moving (/tf).
class Transforms {
 public:
  // A frame has one parent; one that has another already keeps it. A leading '/' of a name is
  // dropped, as TF 2 does. What is no rotation or has no finite number is passed over.
  void add(const messages::TransformStamped& transform, bool is_static);

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
  static std::optional<core::Rigid3> pose_at(const Link& link, std::int64_t stamp_ns);

  std::map<std::string, Link> links_;  // by the child
};

}  // namespace samewhere::input
