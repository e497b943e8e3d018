#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>

namespace samewhere::bench {

// What the field's usual check sees of a picture: OpenCV's ORB (Rublee et al., ICCV 2011) with its
// default settings, not the project's own extractor, so that figures compare with others'.
struct OrbFeatures {
  std::vector<cv::Point2f> points_px;
  cv::Mat descriptors;  // one row of 32 bytes a point

  int size() const { return static_cast<int>(points_px.size()); }
};

// At most max_features of an 8-bit grey picture.
OrbFeatures extract_orb(const cv::Mat& grey, int max_features);

// Matches whose nearest neighbour is clearly nearer than the second (ratio 0.8) and that fit one
// fundamental matrix within 3 pixels (OpenCV's RANSAC); 0 where there are fewer than 8 matches. Not
// symmetric: the features of `query` look for theirs in `match`.
int count_inliers(const OrbFeatures& query, const OrbFeatures& match);

}  // namespace samewhere::bench
