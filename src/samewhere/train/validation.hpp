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

// The share of validation views that are found again when seen from elsewhere (distorted_input,
// always warped): among the codes of all undistorted validation views the one most like theirs
// (cosine) is their own, or that of a neighbour in order, which may show the same place. Unlike the
// loss, comparable between codes of any kind. The same distortions for the same config.seed.
double recognition(const ImageSet& images, const Split& split, const Config& config,
                   const Encode& encode);

// What recognition is measured against: the HOG descriptor (describe.method: hog) of the input.
std::vector<float> hog_of_input(const cv::Mat& input);

}  // namespace samewhere::train
