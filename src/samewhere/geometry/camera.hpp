#pragma once

#include <numbers>
#include <optional>

#include <Eigen/Geometry>

#include <samewhere/core/rig.hpp>

namespace samewhere::geometry {

// Where a point in the camera's frame (metres; z forward, x right, y down) appears in the picture,
// eq. (14)-(17) with distortion. Nothing if it is not in front of the camera, or so far aside that
// the distortion would fold it back into the picture. The pixel may lie outside the picture.
std::optional<Eigen::Vector2d> project(const core::Camera& camera,
                                       const Eigen::Vector3d& point_in_camera);

// The same without distortion: where an ideal pinhole of the same intrinsics would see it.
std::optional<Eigen::Vector2d> project_undistorted(const core::Camera& camera,
                                                   const Eigen::Vector3d& point_in_camera);

// The pixel that an ideal pinhole of the same intrinsics would see instead of this one.
Eigen::Vector2d undistort(const core::Camera& camera, const Eigen::Vector2d& pixel);

// Unit vector in the camera's frame towards what is seen at a pixel of the picture as it was taken.
Eigen::Vector3d bearing(const core::Camera& camera, const Eigen::Vector2d& pixel);
// The same for a pixel that undistort() gave.
Eigen::Vector3d bearing_of_undistorted(const core::Camera& camera,
                                       const Eigen::Vector2d& undistorted);

// The intrinsics that the ideal pinhole shares with the camera.
const core::PinholeRadtan& pinhole(const core::Camera& camera);

// K of eq. (17): pixels, homogeneous, of an ideal pinhole from points of its plane z = 1.
Eigen::Matrix3d calibration_matrix(const core::Camera& camera);

// Mean focal length: converts small angles to pixels.
double focal_px(const core::Camera& camera);

// Angle between what an ideal pinhole of the same intrinsics sees at the left and at the right edge
// of the picture, rad. Only of a camera that knows the width of its pictures.
double horizontal_field_of_view_rad(const core::Camera& camera);

// From a long telephoto lens to the widest that a pinhole with radial distortion describes. What
// lies outside is far more often a mistake than a lens.
inline constexpr double kMinFieldOfView_rad = 10.0 * std::numbers::pi / 180.0;
inline constexpr double kMaxFieldOfView_rad = 150.0 * std::numbers::pi / 180.0;

}  // namespace samewhere::geometry
