// Inference by OpenCV dnn.
#ifndef SAMEWHERE_ONNXRUNTIME

#include <utility>

#include <fmt/format.h>
#include <opencv2/core/version.hpp>
#include <opencv2/dnn.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/network/inference.hpp>
#include <samewhere/network/opencv_errors.hpp>

namespace samewhere::network {
namespace {

class OpenCvInference : public Inference {
 public:
  explicit OpenCvInference(const NetworkFile& network) : ends_(network) {
    std::string().swap(ends_.bytes);  // the net below has its own copy of the weights
    const QuietOpenCv quiet;
    try {
      net_ = cv::dnn::readNetFromONNX(network.bytes.data(), network.bytes.size());
      net_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
      net_.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    } catch (const std::exception& error) {
      fail("cannot read", error);
    }
    // what it cannot run it says here, while it is quiet
    const int shape[] = {1, ends_.num_channels, ends_.input_px.height, ends_.input_px.width};
    run(cv::Mat(4, shape, CV_32FC1, cv::Scalar(0.5)));
  }

  std::vector<float> run(const cv::Mat& picture) final {
    const cv::Mat code = forward(as_blob(picture, ends_));
    require_row(ends_, std::vector<std::int64_t>(code.size.p, code.size.p + code.dims));
    core::require(code.type() == CV_32F && code.isContinuous(), "OpenCV gives a row of floats");
    const auto* values = code.ptr<float>();
    return {values, values + code.total()};
  }

 private:
  cv::Mat forward(const cv::Mat& blob) {
    try {
      net_.setInput(blob, ends_.input_name);
      return net_.forward(ends_.output_name);
    } catch (const std::exception& error) {
      fail("cannot run", error);
    }
  }

  [[noreturn]] void fail(const char* what, const std::exception& error) const {
    throw core::InputError(fmt::format("{}: OpenCV {} this as an ONNX network: {}",
                                       ends_.path.string(), what, reason_of(error)));
  }

  NetworkFile ends_;  // without the bytes
  cv::dnn::Net net_;
};

}  // namespace

std::unique_ptr<Inference> make_inference(const NetworkFile& network) {
  return std::make_unique<OpenCvInference>(network);
}

std::string inference_backend() { return "OpenCV dnn " CV_VERSION; }

}  // namespace samewhere::network

#endif
