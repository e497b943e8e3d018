#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <opencv2/core/mat.hpp>

namespace samewhere::twin {

// The bytes of a PNG file that holds the picture as it is: 8-bit grey, 8-bit BGR or 16-bit grey.
// Pressed lightly: writing must not be slower than rendering.
std::string png_bytes(const cv::Mat& picture);

// The picture in the bytes of such a file; nothing if they are damaged or cut short.
std::optional<cv::Mat> picture_of_png(std::string_view bytes);

// Depth in whole units of 1/5000 m, 16-bit, as TUM RGB-D has it; and back, 32-bit float metres. 0
// stands for unknown, and so does what does not fit: 65535 units (13.1 m) and more.
cv::Mat depth_units(const cv::Mat& depth_m);
cv::Mat depth_of_units(const cv::Mat& units);

}  // namespace samewhere::twin
