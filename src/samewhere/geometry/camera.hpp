#pragma once

#include <numbers>
#include <optional>

#include <Eigen/Geometry>

#include <samewhere/core/rig.hpp>

namespace samewhere::geometry {

// Where a point in the camera's frame (metres; z forward, x right, y down) appears in the picture,
// eq. (14)-(17) with distortion. Nothing if it is not in front of the camera (a fisheye may see
// behind itself), or so far aside that the distortion would fold it back into the picture. The
// pixel may lie outside the picture; it is finite.
std::optional<Eigen::Vector2d> project(const core::Camera& camera,
                                       const Eigen::Vector3d& point_in_camera);

// The same without distortion: where an ideal pinhole of the same intrinsics would see it.
std::optional<Eigen::Vector2d> project_undistorted(const core::Camera& camera,
                                                   const Eigen::Vector3d& point_in_camera);

// The pixel that an ideal pinhole of the same intrinsics would see instead of this one. No pinhole
// sees what lies 90 degrees aside: a fisheye's pixels beyond kMaxPinholeAngle_rad stay there.
Eigen::Vector2d undistort(const core::Camera& camera, const Eigen::Vector2d& pixel);

// Unit vector in the camera's frame towards what is seen at a pixel of the picture as it was taken.
Eigen::Vector3d bearing(const core::Camera& camera, const Eigen::Vector2d& pixel);
// The same for a pixel that undistort() gave.
Eigen::Vector3d bearing_of_undistorted(const core::Camera& camera,
                                       const Eigen::Vector2d& undistorted);

// Half the widest angle of view that a picture of an ideal pinhole is made for.
inline constexpr double kMaxPinholeAngle_rad = 85.0 * std::numbers::pi / 180.0;

// The intrinsics that the ideal pinhole shares with the camera. Not of a fisheye.
const core::PinholeRadtan& pinhole(const core::Camera& camera);

// K of eq. (17): pixels, homogeneous, of an ideal pinhole from points of its plane z = 1.
Eigen::Matrix3d calibration_matrix(const core::Camera& camera);

// Width and height of the pictures, px; 0 where the camera does not know them.
Eigen::Vector2i picture_size_px(const core::Camera& camera);

// Focal lengths along x and y, px, and the optical centre.
Eigen::Vector2d focal_lengths_px(const core::Camera& camera);
Eigen::Vector2d centre_px(const core::Camera& camera);

// Whether the mapping of pixels is that of Brown's five coefficients, which the SLAM undistorts
// feature by feature; pictures of other lenses are undistorted as a whole.
bool is_brown(const core::Camera& camera);

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
