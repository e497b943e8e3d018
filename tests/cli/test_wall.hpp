#pragma once

#include <opencv2/imgproc.hpp>

#include <samewhere/core/random.hpp>

namespace samewhere::test {

// A grey picture of 320 x 240 pixels with enough corners for a start.
inline cv::Mat wall() {
  core::Random random(1);
  cv::Mat image(240, 320, CV_8U, cv::Scalar(128));
  for (int i = 0; i < 300; ++i) {
    const cv::Rect square(static_cast<int>(random.index(300)), static_cast<int>(random.index(220)),
                          12, 12);
    image(square).setTo(static_cast<double>(random.index(256)));
  }
  return image;
}

}  // namespace samewhere::test
