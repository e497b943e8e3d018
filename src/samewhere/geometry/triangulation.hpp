#pragma once

#include <optional>

#include <Eigen/Geometry>

#include <samewhere/core/rigid3.hpp>

namespace samewhere::geometry {

// The point, in the first camera's frame, that two cameras see along these bearings (vectors of
// length 1): the midpoint of the two rays weighted by inverse depth. Nothing if the rays point
// apart (the point would lie behind a camera) or are parallel. Source: Lee and Civera,
// "Triangulation: why optimize?", BMVC 2019.
std::optional<Eigen::Vector3d> triangulate(const core::Rigid3& second_from_first,
                                           const Eigen::Vector3d& first_bearing,
                                           const Eigen::Vector3d& second_bearing);

// Angle between two bearings once the rotation between the cameras is undone: what of their
// difference a translation has to explain. In [0, pi].
double parallax_rad(const Eigen::Quaterniond& second_from_first,
                    const Eigen::Vector3d& first_bearing, const Eigen::Vector3d& second_bearing);

}  // namespace samewhere::geometry
