#pragma once

#include <opencv2/core/mat.hpp>

#include <samewhere/core/random.hpp>

namespace samewhere::pairs {

// The picture as another camera might have taken it in other light: coarser, blurred, lit from
// elsewhere, with another tone and noise. Every thing stays where it is in the picture. 8 bit, grey
// or coloured; a new one.
cv::Mat by_another_camera(const cv::Mat& image, core::Random& random);

}  // namespace samewhere::pairs
