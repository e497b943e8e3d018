#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include <samewhere/core/checksum.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/describe/network_describer.hpp>
#include <samewhere/network/inference.hpp>

namespace samewhere::describe {
namespace {

// Goes up when the same networks and card give another vector.
constexpr std::string_view kNetworkVersion = "network 1";

bool is_without_structure(const cv::Mat& image) {
  double darkest = 0.0;
  double brightest = 0.0;
  cv::minMaxIdx(image.reshape(1), &darkest, &brightest);
  if (darkest == brightest) return true;
  if (image.channels() == 1) return false;
  cv::Mat first(image.size(), image.type(), cv::Scalar::all(0));
  first.setTo(cv::Scalar(image.at<cv::Vec3b>(0, 0)));
  return cv::norm(image, first, cv::NORM_INF) == 0.0;
}

// Mean over all positions of a feature map 1xCxHxW.
std::vector<float> mean_of_map(const cv::Mat& map) {
  const int num_positions = map.size[2] * map.size[3];
  std::vector<float> means;
  for (int channel = 0; channel < map.size[1]; ++channel) {
    const auto* const values = map.ptr<float>(0, channel);
    double sum = 0.0;
    for (int i = 0; i < num_positions; ++i) sum += values[i];
    means.push_back(static_cast<float>(sum / num_positions));
  }
  return means;
}

std::unique_ptr<network::Trunk> trunk_of(const network::TrunkSpec& spec, const Config& config) {
  return network::make_trunk(network::find_trunk(config.trunks, spec.file), spec);
}

class TrunkMean : public Describer {
 public:
  TrunkMean(const network::TrunkSpec& spec, const Config& config)
      : name_(spec.file),
        trunk_(trunk_of(spec, config)),
        checksum_(
            core::checksum(fmt::format("{} mean {:016x}", kNetworkVersion, trunk_->checksum()))) {}

  core::Descriptor describe(core::FrameId frame, const cv::Mat& image) override {
    std::vector<float> code = mean_of_map(trunk_->run(image));
    if (is_without_structure(image)) std::fill(code.begin(), code.end(), 0.0F);
    require_finite(code, name_, frame);
    return {frame, core::unit(code), checksum_};
  }

  std::uint64_t checksum() const override { return checksum_; }

 private:
  std::string name_;
  std::unique_ptr<network::Trunk> trunk_;
  std::uint64_t checksum_;
};

class NetworkDescriber : public Describer {
 public:
  NetworkDescriber(const network::NetworkFile& network, const Config& config)
      : path_(network.path),
        card_(network::read_input_card(network)),
        trunk_(card_.trunk ? trunk_of(*card_.trunk, config) : nullptr),
        inference_(network::make_inference(network)) {
    checksum_ = core::checksum(fmt::format(
        "{} {:016x} {}", kNetworkVersion, network.checksum,
        trunk_ ? fmt::format("{:016x}", trunk_->checksum()) : network::as_text(card_.picture)));
    if (trunk_) require_fit(network);
    code_length_ = code_of(cv::Mat(64, 64, CV_8UC3, cv::Scalar(90, 120, 150))).size();
    if (code_length_ < 2) {
      throw core::InputError(fmt::format(
          "{}: the network's output {} is 1x1; expected one vector, 1xN with N at least 2",
          path_.string(), network.output_name));
    }
  }

  core::Descriptor describe(core::FrameId frame, const cv::Mat& image) override {
    if (is_without_structure(image))
      return {frame, std::vector<float>(code_length_, 0.0F), checksum_};
    const std::vector<float> code = code_of(image);
    require_finite(code, path_.string(), frame);
    return {frame, core::unit(code), checksum_};
  }

  std::uint64_t checksum() const override { return checksum_; }

 private:
  std::vector<float> code_of(const cv::Mat& image) {
    return inference_->run(trunk_ ? trunk_->run(image)
                                  : network::picture_blob(image, card_.picture));
  }

  void require_fit(const network::NetworkFile& network) {
    const cv::Mat map = trunk_->run(cv::Mat(64, 64, CV_8UC3, cv::Scalar(90, 120, 150)));
    const cv::Size size(map.size[3], map.size[2]);
    if (map.size[1] == network.num_channels && size == network.input_px) return;
    throw core::InputError(fmt::format(
        "{}: the network's input is 1x{}x{}x{}; layer {} of {} gives 1x{}x{}x{}, expected the same",
        path_.string(), network.num_channels, network.input_px.height, network.input_px.width,
        card_.trunk->layer, card_.trunk->file, map.size[1], size.height, size.width));
  }

  std::filesystem::path path_;
  network::InputCard card_;
  std::unique_ptr<network::Trunk> trunk_;  // nothing: the network gets the picture
  std::unique_ptr<network::Inference> inference_;
  std::uint64_t checksum_ = 0;
  std::size_t code_length_ = 0;
};

}  // namespace

void require_finite(const std::vector<float>& code, const std::string& file, core::FrameId frame) {
  const auto broken =
      std::find_if_not(code.begin(), code.end(), [](float x) { return std::isfinite(x); });
  if (broken == code.end()) return;
  throw core::InputError(
      fmt::format("{}: number {} of the network's code is {} for frame {}; expected finite numbers",
                  file, broken - code.begin(), *broken, frame.index()));
}

std::unique_ptr<Describer> make_baseline(const std::string& word, const Config& config) {
  if (word == "squeezenet") return std::make_unique<TrunkMean>(network::known_trunk(word), config);
  const auto path = network::find_network("describe.method = " + word, word + ".onnx");
  return make_network_describer(network::read_network(path), config);
}

std::unique_ptr<Describer> make_network_describer(const network::NetworkFile& network,
                                                  const Config& config) {
  return std::make_unique<NetworkDescriber>(network, config);
}

}  // namespace samewhere::describe
