#pragma once

#include <opencv2/core.hpp>

#include <samewhere/core/random.hpp>

namespace samewhere::bench {

// For tests: grey Gaussian noise, rounded and limited to 0 to 255.
inline cv::Mat grey_noise(cv::Size size_px, double mean, double deviation, std::uint64_t seed) {
  core::Random random(seed);
  cv::Mat image(size_px, CV_8U);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<unsigned char>(y, x) =
          cv::saturate_cast<unsigned char>(mean + deviation * random.gaussian());
    }
  }
  return image;
}

}  // namespace samewhere::bench
