#pragma once

#include <vector>

#include <opencv2/core/types.hpp>

#include <samewhere/features/config.hpp>
#include <samewhere/features/features.hpp>

namespace samewhere::features {

// ORB features of the first picture of a frame, spread evenly, with depth where the frame has it. A
// picture without corners, or smaller than 64 pixels on a side, has none.
View extract(const core::Frame& frame, const Config& config);

// 8-bit grey, whatever came in.
cv::Mat as_grey(const cv::Mat& image);

// The `count` keypoints to keep: from each grid cell its strongest in turn, so that no part of the
// picture is left empty while another is crowded. In the order of rank, strength, position.
std::vector<cv::KeyPoint> spread_evenly(std::vector<cv::KeyPoint> keypoints, int count,
                                        int cell_px);

}  // namespace samewhere::features
