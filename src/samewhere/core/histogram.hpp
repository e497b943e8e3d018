#pragma once

#include <array>

#include <opencv2/core/mat.hpp>

namespace samewhere::core {

// S_k, eq. (1)-(3): the share of pixels at level k or darker, for each level k of an 8-bit grey
// image. Ascends to 1. Throws ContractError on an empty image or another type.
std::array<double, 256> cumulative_histogram(const cv::Mat& grey);

// Histogram equalisation, eq. (1)-(4): level k becomes 255 S_k, rounded to nearest. Of two levels
// the brighter stays the brighter or becomes equal, and the brightest present becomes 255: an image
// of one level, black too, becomes white all over, still without structure.
// cv::equalizeHist stretches further, so that the darkest level present becomes 0.
cv::Mat equalize_histogram(const cv::Mat& grey);

}  // namespace samewhere::core
