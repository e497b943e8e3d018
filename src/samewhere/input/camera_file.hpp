#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <opencv2/core/types.hpp>

#include <samewhere/core/rig.hpp>

namespace samewhere::input {

// What a camera file says. Its format is told by its content:
// * rows: three of the matrix K (fx 0 cx, 0 fy cy, 0 0 1); then, if the lens distorts, one row of
// 4,
//   5 or 8 values k1 k2 p1 p2 k3 k4 k5 k6, or `fisheye k1 k2 k3 k4`; then, if the file says so,
//   `width height`: the size in pixels of the pictures that the calibration belongs to; anywhere
//   `depth_factor N`, depth units per metre. Or one row fx fy cx cy and the distortion.
// * YAML or XML of OpenCV; YAML of ORB-SLAM2 and 3, of ROS (camera_info), Kalibr, VINS, EuRoC
// * cameras.txt of COLMAP
// * JSON of OpenCV, nerfstudio, Open3D, RealSense, or with keys fx fy cx cy
struct CameraFile {
  core::Camera camera;                      // width and height 0 if the file does not say
  std::optional<double> depth_units_per_m;  // if the file says
};

// Throws InputError naming file and line if it is anything else than that, or if the numbers are no
// calibration (geometry/camera_check.hpp).
CameraFile read_camera_file(const std::filesystem::path& path);

// The depth units per metre that a camera file says. Nothing if it says none, if the path is empty
// or if the file cannot be read: what is wrong with it is told when its camera is read.
std::optional<double> depth_units_per_m_of(const std::filesystem::path& path);

// The camera for pictures of a size, of which `picture` is one. Throws InputError also if the file
// names another size or the centre lies outside: then the calibration belongs to other pictures.
// Warns in the log at a field of view that hardly a lens has (geometry/camera.hpp).
core::Camera read_camera_file_for(const std::filesystem::path& path, const cv::Size& size_px,
                                  const std::filesystem::path& picture);

// The format of rows: what read_camera_file reads is the camera, to the last digit. A camera
// without a size (width 0) has no row of it.
std::string camera_file_text(const core::Camera& camera);

// The same camera with the size of its pictures.
core::Camera with_size(const core::Camera& camera, const cv::Size& size_px);

// Whether the optical centre lies in the image of width x height: else the calibration belongs to
// other images.
bool is_centre_inside(const core::Camera& camera);

}  // namespace samewhere::input
