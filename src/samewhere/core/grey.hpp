#pragma once

#include <opencv2/core/mat.hpp>

namespace samewhere::core {

// The picture in grey, of the same depth: itself, sharing its pixels, if it has one channel, else
// made of blue, green and red by OpenCV's formula, 0.114 B + 0.587 G + 0.299 R
// (cv::COLOR_BGR2GRAY). Throws ContractError if it has neither one channel nor three.
cv::Mat as_grey(const cv::Mat& image);

}  // namespace samewhere::core
