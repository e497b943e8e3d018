#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

#include <samewhere/twin/render/exposure.hpp>

namespace samewhere::twin {

// What happens to light on its way into the file: a little blur of the lens, vignetting, exposure,
// the noise of photons and of reading them out (both grow with the gain, and follow from the seed),
// a tone curve that rolls off, gamma. Takes linear radiance (CV_32FC3), gives CV_8UC3. Cameras of a
// rig take different seeds.
cv::Mat photograph(const cv::Mat& radiance, const Exposure& exposure, std::uint64_t seed);

}  // namespace samewhere::twin
