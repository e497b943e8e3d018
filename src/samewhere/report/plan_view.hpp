#pragma once

#include <vector>

#include <Eigen/Core>

#include <samewhere/core/rigid3.hpp>

namespace samewhere::report {

// How to look at a path so that most of it can be seen: along the direction in which it extends
// least, its longest direction to the right.
struct PlanView {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::UnitX();
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();  // on the page
  bool is_from_above = false;                     // else it is seen from the side
};

// By the principal axes of the camera's positions, whatever the world's axes are. Which side is
// above follows from how the camera was held (its y axis points down), so the plan is not mirrored.
// `poses` are world_from_camera and finite.
PlanView plan_view_of(const std::vector<core::Rigid3>& poses);

// Metres to the right and up on the page.
Eigen::Vector2d seen(const PlanView& view, const Eigen::Vector3d& in_world);

}  // namespace samewhere::report
