#pragma once

#include <span>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/random.hpp>
#include <samewhere/train/config.hpp>

namespace samewhere::train {

// So many inputs one after the other, and what is to be made of each.
struct Batch {
  int num_examples = 0;
  std::vector<float> inputs;   // num_examples x rows x columns, in [0, 1]
  std::vector<float> targets;  // num_examples x target_length()
};

cv::Size input_size_px(InputSize size);
int target_length(Target target);

// The view as the encoder sees it in use: reduced by averaging, 32-bit float in [0, 1]. `view` is
// 8-bit grey and equalised (describe::preprocess).
cv::Mat encoder_input(const cv::Mat& view, InputSize size);

// The view from somewhere else, in other light, by another camera: see README.md. Same form.
cv::Mat distorted_input(const cv::Mat& view, const Config& config, core::Random& random);

// What is to be made of the distorted view: of the undistorted one its HOG (describe::hog, 12 x 16
// cells), or its pixels, 60 x 80.
std::vector<float> target_of(const cv::Mat& view, Target target);

// Distorted views of images `indices` and their targets. Image i is distorted as `seed` and i say.
Batch make_batch(std::span<const cv::Mat> views, std::span<const int> indices, std::uint64_t seed,
                 const Config& config);

}  // namespace samewhere::train
