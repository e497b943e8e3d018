#pragma once

#include <opencv2/core/mat.hpp>

#include <samewhere/describe/config.hpp>

namespace samewhere::describe {

// The picture that every describer sees: grey, config.height_px x config.width_px, 8 bits,
// equalised (core/histogram.hpp) if config.equalize. The published "360x480" is read as 360 rows of
// 480 columns. `image`: 8-bit grey or BGR of any size from 1x1; anything else throws ContractError.
cv::Mat preprocess(const cv::Mat& image, const Config& config);

}  // namespace samewhere::describe
