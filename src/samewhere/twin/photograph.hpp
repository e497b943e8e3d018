#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

namespace samewhere::twin {

// What happens to light on its way into the file: a little blur of the lens, vignetting, exposure,
// a tone curve that rolls off, gamma, and noise that follows from the seed. Takes linear radiance
// (CV_32FC3) and the exposure over the usual one; gives CV_8UC3.
cv::Mat photograph(const cv::Mat& radiance, float gain, std::uint64_t seed);

}  // namespace samewhere::twin
