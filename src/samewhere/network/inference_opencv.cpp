// Inference by OpenCV dnn.
#ifndef SAMEWHERE_ONNXRUNTIME

#include <utility>

#include <fmt/format.h>
#include <opencv2/core/utility.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/core/version.hpp>
#include <opencv2/dnn.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/network/inference.hpp>

namespace samewhere::network {
namespace {

// OpenCV writes to stderr what it also throws; errors are ours to print.
class QuietOpenCv {
 public:
  QuietOpenCv() : before_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {}
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;
  ~QuietOpenCv() { cv::utils::logging::setLogLevel(before_); }

 private:
  cv::utils::logging::LogLevel before_;
};

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
    run(cv::Mat(ends_.input_px, CV_32FC1, cv::Scalar(0.5)));
  }

  std::vector<float> run(const cv::Mat& picture) final {
    core::require(picture.type() == CV_32FC1 && picture.size() == ends_.input_px,
                  "a network gets the picture it was made for");
    const cv::Mat code = forward(picture);
    require_row(ends_, std::vector<std::int64_t>(code.size.p, code.size.p + code.dims));
    core::require(code.type() == CV_32F && code.isContinuous(), "OpenCV gives a row of floats");
    const auto* values = code.ptr<float>();
    return {values, values + code.total()};
  }

 private:
  cv::Mat forward(const cv::Mat& picture) {
    try {
      const cv::Mat continuous = picture.isContinuous() ? picture : picture.clone();
      const std::vector<int> shape{1, 1, picture.rows, picture.cols};
      net_.setInput(continuous.reshape(1, shape), ends_.input_name);
      return net_.forward(ends_.output_name);
    } catch (const std::exception& error) {
      fail("cannot run", error);
    }
  }

  [[noreturn]] void fail(const char* what, const std::exception& error) const {
    const auto* const known = dynamic_cast<const cv::Exception*>(&error);
    std::string reason = known != nullptr ? known->err : error.what();
    for (char& c : reason) {
      if (c == '\n' || c == '\r') c = ' ';
    }
    throw core::InputError(fmt::format("{}: OpenCV {} this as an ONNX network: {}",
                                       ends_.path.string(), what, reason));
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
