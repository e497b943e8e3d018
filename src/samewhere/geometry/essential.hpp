#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <samewhere/core/rig.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/geometry/ransac.hpp>
#include <samewhere/geometry/ray_pairs.hpp>

namespace samewhere::geometry {

// Essential matrices E with second' E first = 0 (at most ten) through five pairs. Source:
// Stewenius, Engels and Nister, "Recent developments on direct relative orientation", ISPRS Journal
// 2006: the ten cubic constraints on E, solved by the eigenvectors of their action matrix.
std::vector<Eigen::Matrix3d> solve_essential_5(const RayPairs& five);

// Squared distance of each ray from the epipolar line of its partner, square pixels.
TransferError epipolar_error(const Eigen::Matrix3d& essential, const RayPairs& pairs, int i);

// The essential matrix that most pairs agree on, by RANSAC over five pairs; not refined. The error
// of a pair is its Sampson distance.
std::optional<RansacResult<Eigen::Matrix3d>> estimate_essential(const RayPairs& pairs,
                                                                const RansacOptions& options,
                                                                core::Random& random);

// E = K2' F K1: what a fundamental matrix between undistorted pixels says of rays. Essential, that
// is with two equal singular values and one of 0, only as far as F fits the calibration.
Eigen::Matrix3d essential_from_fundamental(const Eigen::Matrix3d& fundamental,
                                           const core::Camera& first, const core::Camera& second);

// The four motions that explain an essential matrix; translations of length 1. Hartley and
// Zisserman 2004, section 9.6.2. Of a matrix that is only nearly essential: the motions of the
// nearest one that is.
std::array<core::Rigid3, 4> motions_of_essential(const Eigen::Matrix3d& essential);

// E = [t]x R.
Eigen::Matrix3d essential_of(const core::Rigid3& second_from_first);

// The motion with the smallest Sampson distances (Huber loss, 1 px wide) near the one given:
// Gauss-Newton on the rotation and the direction of the translation, whose length becomes 1. At
// least 5 pairs, else ContractError.
core::Rigid3 refine_motion(const RayPairs& pairs, const core::Rigid3& second_from_first);

}  // namespace samewhere::geometry
