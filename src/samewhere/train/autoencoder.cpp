#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>

#include <ATen/Parallel.h>
#include <dlfcn.h>
#include <torch/nn/init.h>
#include <torch/nn/modules/batchnorm.h>
#include <torch/nn/modules/conv.h>
#include <torch/nn/modules/linear.h>
#include <torch/optim/adam.h>
#include <torch/serialize.h>
#include <torch/types.h>
#include <torch/utils.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/train/autoencoder.hpp>

namespace samewhere::train {
namespace {

using torch::Tensor;

torch::nn::Conv2dOptions options_of(const ConvolutionPlan& plan) {
  // what a bias would add, the normalisation behind it takes away
  return torch::nn::Conv2dOptions(plan.num_inputs, plan.num_outputs, plan.kernel_px)
      .stride(plan.stride_px)
      .padding(plan.padding_px)
      .bias(false);
}

// Views the numbers, copies nothing.
Tensor tensor_of(std::span<const float> numbers, at::IntArrayRef shape) {
  return torch::from_blob(const_cast<float*>(numbers.data()), shape);  // NOLINT: never written
}

std::vector<float> numbers_of(const Tensor& tensor) {
  const Tensor flat = tensor.contiguous();
  return {flat.data_ptr<float>(), flat.data_ptr<float>() + flat.numel()};
}

class Layers : public torch::nn::Module {
 public:
  explicit Layers(const NetworkPlan& plan) : plan_(plan) {
    for (const ConvolutionPlan& convolution : plan.convolutions) {
      const std::string number = std::to_string(convolutions_.size() + 1);
      convolutions_.push_back(
          register_module("convolution" + number, torch::nn::Conv2d(options_of(convolution))));
      norms_.push_back(
          register_module("norm" + number, torch::nn::BatchNorm2d(convolution.num_outputs)));
    }
    decoder_ = register_module("decoder", torch::nn::Linear(plan.code_size, plan.target_size));
    // at 0 a sigmoid is four times flatter than what it stands for, and would learn as slowly
    torch::nn::init::constant_(norms_.back()->weight, 4.0);
    // what is not known yet is not guessed: it starts from the mean target
    torch::nn::init::zeros_(decoder_->weight);
    torch::nn::init::zeros_(decoder_->bias);
  }

  Tensor encode(Tensor x) {
    for (std::size_t i = 0; i < convolutions_.size(); ++i) {
      x = norms_[i](convolutions_[i](x));
      if (i + 1 < convolutions_.size()) x = torch::max_pool2d(torch::relu(x), 2, 2);
      if (i == 0) x = x * torch::rsqrt(kResponseFloor + x.square().sum(1, true));
    }
    x = torch::avg_pool2d(x, kCodeWindow, kCodeStep);
    return torch::sigmoid(x).flatten(1);
  }

  Tensor forward(const Tensor& x) { return decoder_(encode(x)); }

  // gain (W x - mean) + bias with gain = weight / sqrt(variance + epsilon) is one convolution.
  Convolution folded(std::size_t i) const {
    const torch::NoGradGuard no_gradient;
    const auto& norm = norms_[i];
    const Tensor gain =
        norm->weight * torch::rsqrt(norm->running_var.to(torch::kDouble) + norm->options.eps());
    const Tensor weights = convolutions_[i]->weight * gain.view({-1, 1, 1, 1});
    const Tensor biases = norm->bias - gain * norm->running_mean;
    return {plan_.convolutions[i], numbers_of(weights.to(torch::kFloat)),
            numbers_of(biases.to(torch::kFloat))};
  }

  const NetworkPlan& plan() const { return plan_; }

 private:
  NetworkPlan plan_;
  std::vector<torch::nn::Conv2d> convolutions_;
  std::vector<torch::nn::BatchNorm2d> norms_;
  torch::nn::Linear decoder_{nullptr};
};

using SetNumThreads = void (*)(int);

// Only OpenBLAS has these.
SetNumThreads openblas_set_num_threads() {
  return reinterpret_cast<SetNumThreads>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
}

}  // namespace

struct Autoencoder::Network {
  explicit Network(const NetworkPlan& plan)
      : layers(plan), adam(layers.parameters(), torch::optim::AdamOptions()) {}

  Tensor error(const Batch& batch) {
    const NetworkPlan& plan = layers.plan();
    const std::int64_t n = batch.num_examples;
    const Tensor inputs =
        tensor_of(batch.inputs, {n, 1, plan.input_px.height, plan.input_px.width});
    return torch::mse_loss(layers.forward(inputs), tensor_of(batch.targets, {n, plan.target_size}));
  }

  Layers layers;
  torch::optim::Adam adam;
};

Autoencoder::Autoencoder(const NetworkPlan& plan, std::uint64_t seed) {
  torch::manual_seed(seed);
  network_ = std::make_unique<Network>(plan);
}

Autoencoder::~Autoencoder() = default;

double Autoencoder::learn(const Batch& batch, double learning_rate) {
  network_->layers.train();
  for (auto& group : network_->adam.param_groups()) group.options().set_lr(learning_rate);
  network_->adam.zero_grad();
  const Tensor error = network_->error(batch);
  error.backward();
  network_->adam.step();
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
  const Layers& layers = network_->layers;
  Encoder encoder{.input_px = layers.plan().input_px};
  for (std::size_t i = 0; i < layers.plan().convolutions.size(); ++i) {
    encoder.convolutions.push_back(layers.folded(i));
  }
  return encoder;
}

std::string Autoencoder::state() const {
  torch::serialize::OutputArchive archive;
  torch::serialize::OutputArchive layers;
  torch::serialize::OutputArchive adam;
  network_->layers.save(layers);
  network_->adam.save(adam);
  archive.write("layers", layers);
  archive.write("adam", adam);
  std::ostringstream bytes;
  archive.save_to(bytes);
  return bytes.str();
}

void Autoencoder::restore(const std::string& state) {
  try {
    torch::serialize::InputArchive archive;
    torch::serialize::InputArchive layers;
    torch::serialize::InputArchive adam;
    archive.load_from(state.data(), state.size());
    archive.read("layers", layers);
    archive.read("adam", adam);
    network_->layers.load(layers);
    network_->adam.load(adam);
  } catch (const c10::Error& error) {
    throw core::InputError(std::string("no state of a network: ") + error.what_without_backtrace());
  }
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
