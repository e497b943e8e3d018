#pragma once

#include <optional>
#include <span>
#include <string>

#include <opencv2/core/mat.hpp>

namespace samewhere::input {

// Whether some depth pictures of a recording (CV_32FC1, metres, 0: unknown) contradict together the
// depth units per metre that they were read with: depth cameras measure 0.4 to 10 m, and
// millimetres read as 5000 a metre make a room of 3 m one of 0.6 m. A sentence with the median and
// the factor that would fit; nothing if they do not, or if fewer than 100 pixels have depth.
std::optional<std::string> doubt_about_depth(std::span<const cv::Mat> depths_m, double units_per_m);

}  // namespace samewhere::input
