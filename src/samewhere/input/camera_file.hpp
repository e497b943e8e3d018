#pragma once

#include <filesystem>
#include <string>

#include <opencv2/core/types.hpp>

#include <samewhere/core/rig.hpp>

namespace samewhere::input {

// A camera from a text file: three rows of the matrix K; then, if the lens distorts, one row k1 k2
// p1 p2 k3; then, if the file says so, one row `width height`: the size in pixels of the pictures
// that the calibration belongs to. Without that row they are left 0. Throws InputError naming file
// and line if it is anything else than that.
core::PinholeRadtan read_camera_file(const std::filesystem::path& path);

// The same for pictures of a size, of which `picture` is one. Throws InputError also if the file
// names another size or the centre lies outside: then the calibration belongs to other pictures.
// Warns in the log at a field of view that hardly a lens has (geometry/camera.hpp).
core::PinholeRadtan read_camera_file_for(const std::filesystem::path& path, const cv::Size& size_px,
                                         const std::filesystem::path& picture);

// The same format: what read_camera_file reads is the camera, to the last digit. A camera without a
// size (width 0) has no row of it.
std::string camera_file_text(const core::PinholeRadtan& camera);

// Whether the optical centre lies in the image of width x height: else the calibration belongs to
// other images.
bool is_centre_inside(const core::PinholeRadtan& camera);

}  // namespace samewhere::input
