#pragma once

#include <filesystem>
#include <string>

#include <samewhere/input/calibration.hpp>
#include <samewhere/input/yaml_keys.hpp>

namespace samewhere::input {

// Readers of calibration files, one a family of formats; camera_file.hpp lists the formats and
// tells them apart. Each throws InputError naming the file, the line and what was expected.

// YAML and JSON: OpenCV, ORB-SLAM2 and 3, ROS camera_info, Kalibr, VINS, sensor.yaml, nerfstudio's
// transforms.json, Open3D, and keys fx fy cx cy in general. Of several cameras the first is taken,
// which is told in the log.
Calibration read_yaml_calibration(const YamlKeys& keys);

// XML of OpenCV.
Calibration read_xml_calibration(const std::filesystem::path& file, const std::string& text);

// COLMAP's cameras.txt with one camera. COLMAP has the centre of the upper left pixel at (0.5,
// 0.5).
Calibration read_colmap_calibration(const std::filesystem::path& file);

// Our own rows (camera_file.hpp), or all numbers in one.
Calibration read_rows_calibration(const std::filesystem::path& file);

// How a message lists what is read.
inline constexpr const char* kCalibrationFormats =
    "the rows of `samewhere calibrate` (fx 0 cx, 0 fy cy, 0 0 1, distortion, width height), YAML "
    "or "
    "XML of OpenCV, YAML of ORB-SLAM, ROS camera_info or Kalibr, cameras.txt of COLMAP, or JSON "
    "with "
    "fx fy cx cy";

}  // namespace samewhere::input
