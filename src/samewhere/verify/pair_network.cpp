#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/verify/pair_network.hpp>

namespace samewhere::verify {
namespace {

const cv::Size kPlanes_px(kPairSide_px, kNumPairPlanes* kPairSide_px);

}  // namespace

PairNetwork::PairNetwork(const std::string& setting, const std::string& file)
    : PairNetwork(network::read_network(network::find_network(setting, file))) {}

PairNetwork::PairNetwork(const network::NetworkFile& file)
    : path_(file.path), checksum_(file.checksum) {
  if (file.input_px != kPlanes_px) {
    throw core::InputError(fmt::format(
        "{}: the network's input {} is 1x1x{}x{}; expected the planes of a pair, 1x1x{}x{}",
        path_.string(), file.input_name, file.input_px.height, file.input_px.width,
        kPlanes_px.height, kPlanes_px.width));
  }
  inference_ = network::make_inference(file);
  const std::size_t length = inference_->run(cv::Mat::zeros(kPlanes_px, CV_32F)).size();
  if (length != 1) {
    throw core::InputError(fmt::format("{}: the network's output {} is 1x{}; expected one number",
                                       path_.string(), file.output_name, length));
  }
}

double PairNetwork::probability_of_same(const PairView& pair) {
  const double probability = inference_->run(pair.planes).front();
  if (!std::isfinite(probability)) {
    throw core::InputError(
        fmt::format("{}: the network makes {} of a pair; expected a finite number", path_.string(),
                    probability));
  }
  return probability;
}

}  // namespace samewhere::verify
