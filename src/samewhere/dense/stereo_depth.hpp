#pragma once

#include <optional>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/rig.hpp>
#include <samewhere/dense/config.hpp>

namespace samewhere::dense {

// The depth that a rectified pair (8-bit grey or BGR) tells, by semi-global matching (Hirschmueller
// 2008, OpenCV's block matcher): as View has it, of the left picture, 0 where there is no match.
// Throws InputError if the pair is not rectified (core/rectified_pair.hpp).
cv::Mat stereo_depth_m(const core::Rig& rig, const cv::Mat& left, const cv::Mat& right,
                       const Config& config);

// The depth of a frame: its own, or that of its pair; nothing if it has neither. Throws as
// stereo_depth_m does.
std::optional<cv::Mat> depth_of(const core::Frame& frame, const Config& config);

}  // namespace samewhere::dense
