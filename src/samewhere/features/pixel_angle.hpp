#pragma once

#include <cmath>

#include <opencv2/core/types.hpp>

namespace samewhere::features {

// How many times as wide a pixel of this picture is as one of a picture of 640 x 480 pixels, at
// the same field of view; 1 for pictures of 480 x 360 pixels and more. A corner is located to about
// a pixel, so angles that tell a point from noise grow by this factor.
inline double pixel_width_ratio(const cv::Size& image_size_px) {
  constexpr double kUsualArea_px = 640.0 * 480.0;
  constexpr double kSmallArea_px = 480.0 * 360.0;
  const double area_px = static_cast<double>(image_size_px.width) * image_size_px.height;
  return area_px > 0.0 && area_px < kSmallArea_px ? std::sqrt(kUsualArea_px / area_px) : 1.0;
}

}  // namespace samewhere::features
