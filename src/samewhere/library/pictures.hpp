#pragma once

#include <string>

#include <opencv2/core/mat.hpp>

#include <samewhere/types.hpp>

namespace samewhere::library {

// Throws core::InputError, which begins with `name`, for an image without data, of no size, with
// rows that overlap, or of a format for the other purpose.
void check_image(const std::string& name, const Image& image, bool is_depth);

// Copies of images that were checked: 8-bit grey or BGR; depth in metres, 0 = unknown.
cv::Mat picture_of(const Image& image);
cv::Mat depth_of(const Image& image);

}  // namespace samewhere::library
