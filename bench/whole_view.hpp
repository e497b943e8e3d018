#pragma once

#include <filesystem>
#include <vector>

#include <opencv2/core/mat.hpp>
#include <opencv2/dnn.hpp>

namespace samewhere::bench {

// MobileNetV2's last layer before its classes (1280 numbers, length 1): what the whole view looks
// like to a network that learnt to tell everyday objects apart.
class MobileNet {
 public:
  // Throws InputError if the file is missing or no network.
  explicit MobileNet(const std::filesystem::path& onnx_file);

  // `bgr` is 8-bit with three channels; it is squeezed to 224x224 whole.
  std::vector<float> describe(const cv::Mat& bgr);

 private:
  cv::dnn::Net network_;
};

}  // namespace samewhere::bench
