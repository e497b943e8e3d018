#pragma once

#include <optional>
#include <string>

#include <opencv2/core/mat.hpp>

namespace samewhere::input {

// Whether a depth picture (CV_32FC1, metres, 0: unknown) contradicts the depth units per metre that
// it was read with: depth cameras measure 0.4 to 10 m, and millimetres read as 5000 a metre make a
// room of 3 m one of 0.6 m. A sentence with the median and the factor that would fit; nothing if it
// does not, or if fewer than 100 pixels have depth.
std::optional<std::string> doubt_about_depth(const cv::Mat& depth_m, double units_per_m);

}  // namespace samewhere::input
