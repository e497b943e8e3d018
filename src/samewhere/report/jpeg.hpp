#pragma once

#include <string>
#include <string_view>

#include <opencv2/core/mat.hpp>

namespace samewhere::report {

constexpr int kThumbnailWidth_px = 240;  // of the pictures in reports and maps

// The picture (8-bit grey or BGR, not empty) as JPEG, at most max_width_px wide: shrunk if need be,
// never enlarged.
std::string jpeg_bytes(const cv::Mat& image, int max_width_px);

std::string base64(std::string_view bytes);

// JPEG as something an <img src> takes.
std::string jpeg_data_uri(std::string_view jpeg);

}  // namespace samewhere::report
