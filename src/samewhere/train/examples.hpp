#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/random.hpp>
#include <samewhere/train/config.hpp>
#include <samewhere/train/place_pairs.hpp>

namespace samewhere::train {

// So many inputs one after the other, and what is to be made of each. With pairs: first one view of
// each pair, then the other of each in the same order.
struct Batch {
  int num_examples = 0;
  std::vector<float> inputs;               // num_examples x rows x columns, in [0, 1]
  std::vector<float> targets;              // num_examples x target_length(), scaled
  std::vector<std::uint8_t> other_places;  // PlacePairs::other_places; empty without pairs
};

cv::Size input_size_px(InputSize size);
int target_length(Target target);

// The view as the encoder sees it in use, describe::network_input. `view` is 8-bit grey and
// equalised (describe::preprocess).
cv::Mat encoder_input(const cv::Mat& view, InputSize size);

// The view from somewhere else, in other light, by another camera: see README.md. Same form.
cv::Mat distorted_input(const cv::Mat& view, const Config& config, core::Random& random);

// The same of a picture in colour, BGR, before anything else is done with it; its size stays.
cv::Mat distorted_picture(const cv::Mat& bgr, core::Random& random);

// What is to be made of the distorted view: of the undistorted one its HOG (describe::hog, 12 x 16
// cells), or its pixels, 60 x 80.
std::vector<float> target_of(const cv::Mat& view, Target target);

// What targets are like on average. The network learns (target - mean) / deviation, so that its
// mean squared error is the share of the targets' variance that it cannot tell: 1 for one that has
// learnt nothing, whatever the kind of target.
struct TargetScale {
  std::vector<float> mean;  // of each number
  float deviation = 1.0F;   // standard deviation from it, over all numbers
};

// Of the views `indices`, at least one.
TargetScale scale_of_targets(std::span<const cv::Mat> views, std::span<const int> indices,
                             Target target);

// Makes batches of some views.
class ExampleMaker {
 public:
  // `images` must outlive it.
  ExampleMaker(const Config& config, const ImageSet& images, const Split& split, TargetScale scale);

  // Distorted views `indices` and their scaled targets; if config.contrast is not 0 twice as many:
  // a partner of each behind them, distorted otherwise. View i is distorted as `seed` and i say.
  Batch batch(std::span<const int> indices, std::uint64_t seed) const;
  // The view as it is.
  cv::Mat input(int index) const;

 private:
  void add(int index, core::Random& random, Batch& batch) const;

  Config config_;
  std::span<const cv::Mat> views_;
  PlacePairs pairs_;
  TargetScale scale_;
};

}  // namespace samewhere::train
