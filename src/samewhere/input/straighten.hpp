#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/matx.hpp>

#include <samewhere/core/rig.hpp>

namespace samewhere::input {

// Where each pixel of a new picture lies in the picture as it was taken.
struct PixelMap {
  cv::Mat x_px;  // CV_32FC1, of the new picture's size
  cv::Mat y_px;

  // The new picture; black where the taken one shows nothing.
  cv::Mat apply(const cv::Mat& taken, int interpolation) const;
};

// Pictures of a camera without Brown's distortion (a fisheye, a rational lens) are turned into
// those of an ideal pinhole of the same size and optical axis. What lies farther aside than half of
// this along the longer side is cut off: a plane picture spends its pixels on its border.
inline constexpr double kWidestPinhole_deg = 110.0;

// That pinhole: the widest, up to kWidestPinhole_deg, whose whole picture the camera has taken.
// Throws InputError if there is none. Only of a camera that knows the size of its pictures.
core::PinholeRadtan ideal_pinhole(const core::Camera& camera);

// The map from the picture that `camera` took to that of the pinhole `turned`, whose axes are those
// of the camera turned by `turned_from_taken`.
PixelMap pixel_map(const core::Camera& camera, const core::PinholeRadtan& turned,
                   const cv::Matx33d& turned_from_taken);

}  // namespace samewhere::input
