#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <samewhere/core/frame.hpp>

namespace samewhere::features {

// The features of one picture, as arrays of equal length.
struct Features {
  std::vector<Eigen::Vector2f> raw_px;  // where they are in the picture
  std::vector<Eigen::Vector2f>
      undistorted_px;  // where an ideal pinhole would see them; equal to raw_px if uncalibrated
  std::vector<float> depth_m;     // along the optical axis, 0 = unknown
  std::vector<float> right_x_px;  // x in the right picture of a rectified pair, real or virtual
                                  // (baseline_m of stereo.hpp), NaN = unknown
  std::vector<int> octave;        // pyramid level, 0 = full size
  std::vector<float> angle_rad;   // orientation of the patch
  std::vector<std::array<std::uint8_t, 3>> rgb;  // colour of the pixel
  cv::Mat descriptors;                           // size() x 32 bytes

  int size() const { return static_cast<int>(raw_px.size()); }
};

// One picture, as recognition and geometry see it: what is left of a frame when the picture is
// gone.
struct View {
  core::FrameId frame;
  double stamp_s = 0.0;
  std::shared_ptr<const core::Rig> rig;
  cv::Size image_size_px;
  std::shared_ptr<const Features> features;
};

// Where feature i is in the camera's frame, metres. Nothing without depth or calibration.
std::optional<Eigen::Vector3d> point_in_camera(const View& view, int feature);

}  // namespace samewhere::features
