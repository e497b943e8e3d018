#pragma once

#include <vector>

#include <Eigen/Core>

#include <samewhere/core/rigid3.hpp>

namespace samewhere::geometry {

// The transform that brings points onto their partners best: the least squares solution of
// to[i] = scale * R * from[i] + t (Umeyama, "Least-squares estimation of transformation parameters
// between two point patterns", PAMI 1991). Without scale, `scale` is exactly 1.
//
// At least 3 pairs of finite points, else ContractError. What the points leave open is decided, not
// left to rounding: if either set lies on a line, the rotation about that line is free, and of all
// best rotations the answer is the one that turns least; if either set is a single point, no
// rotation and no scale is determined, and they stay identity and 1.
core::Sim3 align_points(const std::vector<Eigen::Vector3d>& from,
                        const std::vector<Eigen::Vector3d>& to, bool with_scale);

}  // namespace samewhere::geometry
