#pragma once

#include <vector>

#include <Eigen/Core>

namespace samewhere::geometry {

// Moves the points' mean to 0 and their mean distance to sqrt(2), so that linear equations in
// homogeneous coordinates are well scaled (Hartley 1997). At least one point.
Eigen::Matrix3d normalising_transform(const std::vector<Eigen::Vector2d>& points);

}  // namespace samewhere::geometry
