#pragma once

#include <opencv2/core/mat.hpp>

#include <samewhere/core/rig.hpp>
#include <samewhere/dense/config.hpp>

namespace samewhere::dense {

// The depth that a rectified pair (8-bit grey or BGR) tells, by semi-global matching (Hirschmueller
// 2008, OpenCV's block matcher): as View has it, of the left picture, 0 where there is no match.
// Throws InputError if the pair is not rectified (core/rectified_pair.hpp).
cv::Mat stereo_depth_m(const core::Rig& rig, const cv::Mat& left, const cv::Mat& right,
                       const Config& config);

}  // namespace samewhere::dense
