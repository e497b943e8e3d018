#pragma once

#include <functional>
#include <span>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/train/config.hpp>
#include <samewhere/train/image_set.hpp>

namespace samewhere::train {

// A code for an input (encoder_input).
using Encode = std::function<std::vector<float>(const cv::Mat& input)>;
using Codes = std::vector<std::vector<float>>;

// The share of validation views that are retrieved (share_found) when seen from elsewhere
// (distorted_input, always warped). Unlike the loss, comparable between codes of any kind. The same
// distortions for the same config.seed.
double recognition(const ImageSet& images, const Split& split, const Config& config,
                   const Encode& encode);

// The share of `views` whose query is most like (cosine) their own code among all, or that of a
// neighbour, which may show the same place: at most 4 further in the order of the same source.
// Codes and queries have length 1, or are all zero; of equals the first counts as most like.
double share_found(const ImageSet& images, std::span<const int> views, const Codes& codes,
                   const Codes& queries);

// What recognition is measured against: the HOG descriptor (describe.method: hog) of the input.
std::vector<float> hog_of_input(const cv::Mat& input);

}  // namespace samewhere::train
