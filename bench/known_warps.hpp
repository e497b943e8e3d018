#pragma once

#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>
#include <opencv2/core/matx.hpp>

namespace samewhere::bench {

// A change of a picture that is known exactly: a homography between pixels, and light.
struct Warp {
  std::string name;
  cv::Matx33d second_from_first;
  double contrast = 1.0;      // grey levels are multiplied by it about 128
  double brightness = 0.0;    // and this is added
  double noise_levels = 0.0;  // standard deviation of what is added to each pixel
};

// Turned, nearer and further away, seen from the side, darker and brighter; each with a little
// noise. For a picture of this size.
std::vector<Warp> known_warps(const cv::Size& size_px);

// The second picture. Noise is drawn with `seed`.
cv::Mat warped(const cv::Mat& grey, const Warp& warp, std::uint64_t seed);

// Points and 32-byte descriptors of a picture.
struct PointTable {
  std::vector<cv::Point2f> points_px;
  cv::Mat descriptors;
};

// Repeatability of the features of a picture in its warped copy.
struct Repeat {
  int num_visible = 0;  // features of the first picture that lie inside the second
  int num_again = 0;    // of these, with a feature of the second within 3 pixels
  int num_matches = 0;  // each other's nearest descriptors, ratio to the second nearest below 0.8
  int num_right = 0;    // of these, within 3 pixels of where they belong
  std::vector<double> errors_px;  // of the right ones
};

Repeat find_again(const PointTable& first, const PointTable& second, const Warp& warp,
                  const cv::Size& size_px);

}  // namespace samewhere::bench
