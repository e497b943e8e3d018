#pragma once

#include <array>

#include <opencv2/core/mat.hpp>

#include <samewhere/describe/config.hpp>

namespace samewhere::describe {

// The picture that every describer sees: grey, config.height_px x config.width_px, 8 bits,
// equalised if config.equalize. The published "360x480" is read as 360 rows of 480 columns.
// `image`: 8-bit grey or BGR of any size from 1x1; anything else throws ContractError.
cv::Mat preprocess(const cv::Mat& image, const Config& config);

// S_k, eq. (1)-(3): the share of pixels at level k or darker, for each level k of an 8-bit grey
// image. Ascends to 1. Throws ContractError on an empty image or another type.
std::array<double, 256> cumulative_histogram(const cv::Mat& grey);

// Histogram equalisation, eq. (1)-(4): level k becomes 255 S_k, rounded to nearest. Of two levels
// the brighter stays the brighter or becomes equal, and the brightest present becomes 255: an image
// of one level, black too, becomes white all over, still without structure.
// cv::equalizeHist stretches further, so that the darkest level present becomes 0.
cv::Mat equalize_histogram(const cv::Mat& grey);

}  // namespace samewhere::describe
