#include <cmath>
#include <cstddef>
#include <numbers>

#include <ATen/Parallel.h>
#include <dlfcn.h>
#include <torch/nn/init.h>
#include <torch/nn/modules/linear.h>
#include <torch/utils.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/train/autoencoder.hpp>
#include <samewhere/train/torch_layers.hpp>

namespace samewhere::train {
namespace {

using torch::Tensor;

// The first layer starts as derivatives of a Gaussian in as many directions as it has channels.
void point_edges_all_ways(Tensor& weight) {
  const torch::NoGradGuard no_gradient;
  const std::int64_t num_channels = weight.size(0);
  const std::int64_t side = weight.size(2);
  const Tensor at = torch::arange(side) - 0.5 * static_cast<double>(side - 1);
  const double sigma = static_cast<double>(side - 1) / 4.0;
  const Tensor bell = torch::exp(-at.square() / (2.0 * sigma * sigma));
  const Tensor along = torch::outer(bell, bell * at) / static_cast<double>(side);
  for (std::int64_t i = 0; i < num_channels; ++i) {
    const double angle =
        2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(num_channels);
    weight[i][0].copy_(std::cos(angle) * along + std::sin(angle) * along.t());
  }
}

class Layers : public torch::nn::Module {
 public:
  explicit Layers(const NetworkPlan& plan) : plan_(plan) {
    for (const ConvolutionPlan& convolution : plan.convolutions) {
      const std::string number = std::to_string(convolutions_.size() + 1);
      convolutions_.push_back(register_module("convolution" + number,
                                              std::make_shared<NormedConvolution>(convolution)));
    }
    decoder_ = register_module("decoder", torch::nn::Linear(plan.code_size, plan.target_size));
    point_edges_all_ways(convolutions_.front()->weight());
    // at 0 a sigmoid is four times flatter than what it stands for, and would learn as slowly
    torch::nn::init::constant_(convolutions_.back()->norm()->weight, 4.0);
    // what is not known yet is not guessed: it starts from the mean target
    torch::nn::init::zeros_(decoder_->weight);
    torch::nn::init::zeros_(decoder_->bias);
  }

  Tensor encode(Tensor x) {
    for (std::size_t i = 0; i < convolutions_.size(); ++i) {
      x = convolutions_[i]->forward(x);
      if (i + 1 < convolutions_.size()) x = torch::relu(x);
      if (i > 0) continue;
      x = torch::avg_pool2d(x, kCellSide, kCellSide);
      x = x * torch::rsqrt(kResponseFloor + x.square().sum(1, true));
    }
    x = torch::avg_pool2d(x, kCodeWindow, kCodeStep);
    return torch::sigmoid(x).flatten(1);
  }

  Tensor decode(const Tensor& codes) { return decoder_(codes); }

  std::vector<Convolution> folded() const {
    std::vector<Convolution> all;
    for (const auto& convolution : convolutions_) all.push_back(convolution->folded());
    return all;
  }

  const NetworkPlan& plan() const { return plan_; }

 private:
  NetworkPlan plan_;
  std::vector<std::shared_ptr<NormedConvolution>> convolutions_;
  torch::nn::Linear decoder_{nullptr};
};

using SetNumThreads = void (*)(int);

// Only OpenBLAS has these.
SetNumThreads openblas_set_num_threads() {
  return reinterpret_cast<SetNumThreads>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
}

}  // namespace

struct Autoencoder::Network {
  Network(const NetworkPlan& plan, const ContrastConfig& contrast_config)
      : contrast(contrast_config),
        layers(plan),
        adam(layers.parameters(), torch::optim::AdamOptions()) {}

  Tensor error(const Batch& batch) {
    const NetworkPlan& plan = layers.plan();
    const std::int64_t n = batch.num_examples;
    const Tensor inputs =
        tensor_of(batch.inputs, {n, 1, plan.input_px.height, plan.input_px.width});
    const Tensor codes = layers.encode(inputs);
    const Tensor error =
        torch::mse_loss(layers.decode(codes), tensor_of(batch.targets, {n, plan.target_size}));
    if (contrast.weight == 0.0 || batch.other_places.empty()) return error;
    return error +
           contrast.weight * contrastive_loss(codes, batch.other_places, contrast.temperature);
  }

  ContrastConfig contrast;
  Layers layers;
  torch::optim::Adam adam;
};

Autoencoder::Autoencoder(const NetworkPlan& plan, std::uint64_t seed,
                         const ContrastConfig& contrast) {
  torch::manual_seed(seed);
  network_ = std::make_unique<Network>(plan, contrast);
}

Autoencoder::~Autoencoder() = default;

double Autoencoder::learn(const Batch& batch, double learning_rate) {
  network_->layers.train();
  const Tensor error = network_->error(batch);
  step_down(error, learning_rate, network_->adam);
  return error.item().toDouble();
}

double Autoencoder::error(const Batch& batch) {
  const torch::NoGradGuard no_gradient;
  network_->layers.eval();
  return network_->error(batch).item().toDouble();
}

std::vector<float> Autoencoder::encode(std::span<const float> inputs) {
  const torch::NoGradGuard no_gradient;
  network_->layers.eval();
  const cv::Size size_px = network_->layers.plan().input_px;
  return numbers_of(network_->layers.encode(
      tensor_of(inputs, {static_cast<std::int64_t>(inputs.size()) / size_px.area(), 1,
                         size_px.height, size_px.width})));
}

Encoder Autoencoder::encoder() const {
  return {network_->layers.plan().input_px, network_->layers.folded()};
}

std::string Autoencoder::state() const { return state_of(network_->layers, network_->adam); }

void Autoencoder::restore(const std::string& state) {
  restore_state(state, network_->layers, network_->adam);
}

void set_num_threads(int num_threads) {
  core::require(num_threads > 0, "work is done by at least one thread");
  at::set_num_threads(num_threads);
  if (const SetNumThreads set = openblas_set_num_threads()) set(num_threads);
}

std::string advice_on_linear_algebra() {
  if (openblas_set_num_threads() != nullptr) return "";
  return "the reference BLAS is in use and training is several times slower than it need be: "
         "install libopenblas0-pthread, or choose it by `update-alternatives --config "
         "libblas.so.3-x86_64-linux-gnu`";
}

}  // namespace samewhere::train
