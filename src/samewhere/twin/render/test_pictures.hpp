#pragma once

#include <cstring>

#include <opencv2/core.hpp>

namespace samewhere::twin {

// Whether both have the same size, type and bytes. For tests only.
inline bool is_same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() &&
         std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

}  // namespace samewhere::twin
