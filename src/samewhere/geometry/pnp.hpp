#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/geometry/ransac.hpp>

namespace samewhere::geometry {

// Points whose position is known and the directions in which a camera saw them.
struct PnpProblem {
  std::vector<Eigen::Vector3d> points_in_world;  // metres
  std::vector<Eigen::Vector3d> bearings;         // unit vectors in the camera, as many
  double focal_px = 1.0;                         // converts errors on the plane z = 1 to pixels
};

// All poses camera_from_world (at most four) that see three points exactly along three bearings.
// None for points on a line. Source: Grunert 1841 in the form of Haralick, Lee, Ottenberg and
// Noelle, IJCV 1994.
std::vector<core::Rigid3> solve_p3p(const std::array<Eigen::Vector3d, 3>& points_in_world,
                                    const std::array<Eigen::Vector3d, 3>& bearings);

// The pose camera_from_world that most observations agree on, by RANSAC over solve_p3p; not
// refined. Errors are reprojection errors in pixels. Nothing if too few agree.
std::optional<RansacResult<core::Rigid3>> estimate_pose(const PnpProblem& problem,
                                                        const RansacOptions& options,
                                                        core::Random& random);

}  // namespace samewhere::geometry
