#pragma once

#include <memory>

#include <opencv2/core/types.hpp>

#include <samewhere/core/source.hpp>

namespace samewhere::input {

// By what factor pictures of this size are enlarged: to about as many pixels as 640 x 480 has; 1
// for pictures of 480 x 360 pixels and more. Corners are found at whole pixels, and where a pixel
// of a small picture is a wide angle, depths from motion are as coarse.
double enlargement_of(const cv::Size& size_px);

// The same source with the pictures of small cameras enlarged (linear interpolation; depth: the
// nearest pixel), and the calibration with them. Every camera must be a PinholeRadtan, as behind
// rectified(); all cameras of a frame have pictures of one size. Frames of other sources pass as
// they are, those without calibration, too.
std::unique_ptr<core::Source> enlarged(std::unique_ptr<core::Source> source);

}  // namespace samewhere::input
