#pragma once

#include <opencv2/core/mat.hpp>

#include <samewhere/twin/walkthrough.hpp>

namespace samewhere::twin {

// Twelve pictures of a walk, evenly spread in time from first to last, in rows of four, each 320 x
// 240. BGR, 8 bits.
cv::Mat contact_sheet(const Walkthrough& walk);

}  // namespace samewhere::twin
