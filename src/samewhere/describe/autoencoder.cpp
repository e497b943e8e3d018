#include <utility>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/checksum.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/describe/autoencoder.hpp>
#include <samewhere/describe/network_describer.hpp>
#include <samewhere/describe/preprocess.hpp>
#include <samewhere/network/inference.hpp>

namespace samewhere::describe {
namespace {

// Goes up when the same network and settings give another vector.
constexpr std::string_view kVersion = "autoencoder 1";

// Where the file lies and how HOG is set does not change the code.
std::uint64_t checksum_of(Config config, const network::NetworkFile& network) {
  config.network.clear();
  config.trunks.clear();
  config.hog = HogConfig{};
  return core::checksum(
      fmt::format("{}\n{:016x}\n{}", kVersion, network.checksum, core::config_as_yaml(config)));
}

bool is_of_one_level(const cv::Mat& grey) {
  double darkest = 0.0;
  double brightest = 0.0;
  cv::minMaxLoc(grey, &darkest, &brightest);
  return darkest == brightest;
}

class Autoencoder : public Describer {
 public:
  Autoencoder(const Config& config, const network::NetworkFile& network)
      : config_(config),
        path_(network.path),
        input_px_(network.input_px),
        checksum_(checksum_of(config, network)),
        inference_(network::make_inference(network)) {
    // whether it can be run shows only here, and is better known before the first frame
    code_length_ = inference_->run(cv::Mat(input_px_, CV_32FC1, cv::Scalar(0.5))).size();
    if (code_length_ < 2) {
      throw core::InputError(
          fmt::format("{}: the network's output {} is 1x1; expected one vector, 1xN with N at "
                      "least 2",
                      path_.string(), network.output_name));
    }
  }

  core::Descriptor describe(core::FrameId frame, const cv::Mat& image) override {
    const cv::Mat prepared = preprocess(image, config_);
    if (is_of_one_level(prepared)) {
      return {frame, std::vector<float>(code_length_, 0.0F), checksum_};
    }
    const std::vector<float> code = inference_->run(network_input(prepared, input_px_));
    require_finite(code, path_.string(), frame);
    return {frame, core::unit(code), checksum_};
  }

  std::uint64_t checksum() const override { return checksum_; }

 private:
  Config config_;
  std::filesystem::path path_;
  cv::Size input_px_;
  std::uint64_t checksum_;
  std::unique_ptr<network::Inference> inference_;
  std::size_t code_length_ = 0;
};

}  // namespace

cv::Mat network_input(const cv::Mat& prepared, cv::Size input_px) {
  const bool is_shrunk = input_px.width <= prepared.cols && input_px.height <= prepared.rows;
  cv::Mat reduced;
  cv::resize(prepared, reduced, input_px, 0.0, 0.0, is_shrunk ? cv::INTER_AREA : cv::INTER_LINEAR);
  cv::Mat picture;
  reduced.convertTo(picture, CV_32F, 1.0 / 255.0);
  return picture;
}

std::unique_ptr<Describer> make_autoencoder(const Config& config) {
  const auto network =
      network::read_network(network::find_network("describe.network", config.network));
  if (network.num_channels == 1) return std::make_unique<Autoencoder>(config, network);
  return make_network_describer(network, config);
}

}  // namespace samewhere::describe
