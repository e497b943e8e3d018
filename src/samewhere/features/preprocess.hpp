#pragma once

#include <opencv2/core/mat.hpp>

#include <samewhere/features/config.hpp>

namespace samewhere::features {

// The picture in which corners are looked for and described, of the same size: grey, its noise
// taken out by a median of 3 x 3 pixels if config.denoise, its histogram equalised
// (core/histogram.hpp) if config.equalize. In this order, since equalisation spreads the levels of
// an even surface and its noise with them. With neither it is core::as_grey, which shares the
// pixels of a grey picture. `image`: 8-bit grey or BGR with at least one pixel.
cv::Mat preprocess(const cv::Mat& image, const Config& config);

}  // namespace samewhere::features
