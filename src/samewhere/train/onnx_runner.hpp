#pragma once

#include <string_view>
#include <vector>

#include <opencv2/core/mat.hpp>
#include <opencv2/dnn/dnn.hpp>

namespace samewhere::train {

// Runs an exported network as a user's program does, with OpenCV.
class OnnxRunner {
 public:
  explicit OnnxRunner(std::string_view bytes)
      : network_(cv::dnn::readNetFromONNX(bytes.data(), bytes.size())) {}

  // The code of one input (encoder_input).
  std::vector<float> encode(const cv::Mat& input) {
    network_.setInput(cv::dnn::blobFromImage(input), "image");
    const cv::Mat code = network_.forward("code");
    return {code.begin<float>(), code.end<float>()};
  }

 private:
  cv::dnn::Net network_;
};

}  // namespace samewhere::train
