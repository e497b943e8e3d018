#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/random.hpp>
#include <samewhere/train/image_set.hpp>

namespace samewhere::train {

// A grey picture of random bars; `number` makes pictures differ. For tests only.
inline cv::Mat test_picture(int number, cv::Size size_px = {320, 240}) {
  core::Random random(core::seed_of(5, "test picture", static_cast<std::uint64_t>(number)));
  cv::Mat picture(size_px, CV_8UC1, cv::Scalar(random.uniform(60.0, 200.0)));
  for (int i = 0; i < 12; ++i) {
    const auto x = static_cast<int>(random.uniform(0.0, 0.9 * size_px.width));
    const auto y = static_cast<int>(random.uniform(0.0, 0.9 * size_px.height));
    const auto width = static_cast<int>(random.uniform(0.05, 0.4) * size_px.width);
    const auto height = static_cast<int>(random.uniform(0.05, 0.4) * size_px.height);
    cv::rectangle(picture, {x, y, width, height}, random.uniform(0.0, 255.0), cv::FILLED);
  }
  return picture;
}

inline ImageSet test_images(int num_images) {
  ImageSet images{.sources = {{"pictures", num_images, 0}}, .sha256 = "of pictures"};
  for (int i = 0; i < num_images; ++i) images.views.push_back(test_picture(i));
  return images;
}

// A network so small that an epoch takes a moment.
inline Config test_config() {
  return {.epochs = 4, .batch = 4, .threads = 1, .code_size = 240, .channels = 2};
}

}  // namespace samewhere::train
