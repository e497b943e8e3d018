#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/paged_memory.hpp>

namespace samewhere::features {

// An array in ordinary memory or in paged memory (paged.hpp).
template <class T>
using Array = std::pmr::vector<T>;

// The features of one picture, as arrays of equal length.
struct Features {
  Array<Eigen::Vector2f> raw_px;  // where they are in the picture
  Array<Eigen::Vector2f>
      undistorted_px;    // where an ideal pinhole would see them; equal to raw_px if uncalibrated
  Array<float> depth_m;  // along the optical axis, 0 = unknown
  Array<float> right_x_px;  // x in the right picture of a rectified pair, real or virtual
                            // (baseline_m of stereo.hpp), NaN = unknown
  Array<int> octave;        // pyramid level, 0 = full size
  Array<float> angle_rad;   // orientation of the patch
  Array<std::array<std::uint8_t, 3>> rgb;  // colour of the pixel
  cv::Mat descriptors;                     // size() x 32 bytes

  std::shared_ptr<const core::PagedBlock> pages;  // in which they lie, if they are paged

  int size() const { return static_cast<int>(raw_px.size()); }
};

// A view: the features of a frame, without its image.
struct View {
  core::FrameId frame;
  double stamp_s = 0.0;
  std::shared_ptr<const core::Rig> rig;
  cv::Size image_size_px;
  std::shared_ptr<const Features> features;
};

// Where feature i is in the camera's frame, metres. Nothing without depth or calibration.
std::optional<Eigen::Vector3d> point_in_camera(const View& view, int feature);

// Whether the depth of any feature is known.
bool has_depth(const View& view);

}  // namespace samewhere::features
