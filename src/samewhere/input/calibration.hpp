#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include <samewhere/core/rig.hpp>

namespace samewhere::input {

// What a calibration file of any format says (camera_file.hpp lists them), before it is checked.
// The centre of the upper left pixel is (0, 0).
struct Calibration {
  std::string place;  // of the file, for messages
  cv::Size size_px;   // of the pictures that it belongs to; 0 x 0: the file does not say
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  bool is_fisheye = false;         // Kannala-Brandt; else radial-tangential
  std::vector<double> distortion;  // in OpenCV's order; empty: none
  std::optional<double> depth_units_per_m;
};

// Whether a model of lens or distortion is the fisheye of Kannala and Brandt, by any of the names
// that it goes by (equidistant, fisheye, KannalaBrandt8, OPENCV_FISHEYE ...); false for the pinhole
// and its radial-tangential distortion (pinhole, radtan, plumb_bob, rational_polynomial ...).
// Throws InputError, which begins with `place`, for any other model.
bool is_fisheye_model(const std::string& place, const std::string& model);

// The camera. Throws InputError if there are more or fewer numbers than its model has, or if they
// are no calibration (geometry/camera_check.hpp).
core::Camera camera_of(const Calibration& calibration);

}  // namespace samewhere::input
