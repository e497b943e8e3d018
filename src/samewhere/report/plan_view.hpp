#pragma once

#include <vector>

#include <Eigen/Core>

#include <samewhere/core/rigid3.hpp>

namespace samewhere::report {

// Projection of a path for a plot: along its direction of least extent, the longest direction to
// the right.
struct PlanView {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::UnitX();
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();  // on the page
  bool is_from_above = false;                     // else from the side
};

// From the principal axes of the camera positions, independent of the world axes. The y axes of the
// cameras point down and tell which side is above, so the plan is not mirrored.
// `poses` are world_from_camera and finite.
PlanView plan_view_of(const std::vector<core::Rigid3>& poses);

// Metres to the right and up on the page.
Eigen::Vector2d seen(const PlanView& view, const Eigen::Vector3d& in_world);

}  // namespace samewhere::report
