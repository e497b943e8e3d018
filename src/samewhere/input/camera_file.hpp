#pragma once

#include <filesystem>

#include <samewhere/core/rig.hpp>

namespace samewhere::input {

// A camera from a text file: three rows of the matrix K, then, if the lens distorts, one row k1 k2
// p1 p2 k3. The file says nothing about the image size: width and height are left 0. Throws
// InputError naming file and line if it is anything else than that.
core::PinholeRadtan read_camera_file(const std::filesystem::path& path);

// Whether the optical centre lies in the image of width x height: else the calibration belongs to
// other images.
bool is_centre_inside(const core::PinholeRadtan& camera);

}  // namespace samewhere::input
