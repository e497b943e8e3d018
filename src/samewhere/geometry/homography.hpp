#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/geometry/ransac.hpp>
#include <samewhere/geometry/ray_pairs.hpp>

namespace samewhere::geometry {

// How a plane, or anything under a rotation, moves between two calibrated pictures; both ways on
// the plane z = 1.
struct Homography {
  Eigen::Matrix3d second_from_first = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d first_from_second = Eigen::Matrix3d::Identity();
};

// The least squares homography through four or more pairs (direct linear transform with
// normalisation: Hartley and Zisserman 2004, algorithm 4.2). Nothing if degenerate.
std::optional<Homography> solve_homography(const RayPairs& pairs);

// Squared distance between where the first camera's ray should appear in the second picture and
// where it does, and back; square pixels.
TransferError transfer_error(const Homography& homography, const RayPairs& pairs, int i);

// The homography that most pairs agree on: RANSAC over four pairs, refined on its inliers. The
// error of a pair is the larger of the two distances.
std::optional<RansacResult<Homography>> estimate_homography(const RayPairs& pairs,
                                                            const RansacOptions& options,
                                                            core::Random& random);

// A motion and the plane under which a homography arises.
struct PlanarMotion {
  core::Rigid3 second_from_first;  // the distance of the plane from the first camera is 1
  Eigen::Vector3d normal_in_first = Eigen::Vector3d::UnitZ();  // points on the plane have n x = 1
};

// All motions that explain a homography, four of them; which are possible is for the points to say.
// None if it is the homography of a rotation, where neither translation nor plane is determined.
// Source: Ma, Soatto, Kosecka and Sastry, "An Invitation to 3-D Vision", 2004, section 5.3.3.
std::vector<PlanarMotion> motions_of(const Homography& homography);

}  // namespace samewhere::geometry
