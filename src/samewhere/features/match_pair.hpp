#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/features/config.hpp>

namespace samewhere::features {

// Row `first` of one descriptor table and row `second` of another look alike.
struct Match {
  int first = 0;
  int second = 0;
  int distance_bits = 0;
};

// Pairs that are each other's nearest neighbour, not further apart than max_distance_bits, and
// clearly nearer than the second nearest (Lowe 2004: max_ratio). Ascending in `first`.
std::vector<Match> match_pair(const cv::Mat& first, const cv::Mat& second, const Config& config);

}  // namespace samewhere::features
