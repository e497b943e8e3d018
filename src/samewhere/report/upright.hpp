#pragma once

#include <vector>

#include <Eigen/Core>

#include <samewhere/core/rigid3.hpp>

namespace samewhere::report {

// The world as it is shown: which way is up, and which is right in the view from above. Unit
// vectors, orthogonal.
struct Upright {
  Eigen::Vector3d up = -Eigen::Vector3d::UnitY();
  Eigen::Vector3d right = Eigen::Vector3d::UnitX();
};

// Estimated from the poses, independent of the world axes. A camera that is carried does not roll:
// its x axis stays horizontal, whatever its heading and pitch, so up is the direction that the x
// axes have least of. Where the heading hardly changes, up is the mean of the cameras' up axes.
// Right is the direction of largest horizontal extent. `poses` are world_from_camera and finite.
Upright upright_of(const std::vector<core::Rigid3>& poses);

}  // namespace samewhere::report
