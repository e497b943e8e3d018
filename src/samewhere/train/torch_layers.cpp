#include <sstream>

#include <torch/serialize.h>
#include <torch/utils.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/train/torch_layers.hpp>

namespace samewhere::train {
namespace {

torch::nn::Conv2dOptions options_of(const ConvolutionPlan& plan) {
  // what a bias would add, the normalisation behind it takes away
  return torch::nn::Conv2dOptions(plan.num_inputs, plan.num_outputs, plan.kernel_px)
      .stride(plan.stride_px)
      .padding(plan.padding_px)
      .bias(false);
}

}  // namespace

torch::Tensor tensor_of(std::span<const float> numbers, at::IntArrayRef shape) {
  return torch::from_blob(const_cast<float*>(numbers.data()), shape);  // NOLINT: never written
}

std::vector<float> numbers_of(const torch::Tensor& tensor) {
  const torch::Tensor flat = tensor.contiguous();
  return {flat.data_ptr<float>(), flat.data_ptr<float>() + flat.numel()};
}

NormedConvolution::NormedConvolution(const ConvolutionPlan& plan)
    : plan_(plan),
      convolution_(register_module("convolution", torch::nn::Conv2d(options_of(plan)))),
      norm_(register_module("norm", torch::nn::BatchNorm2d(plan.num_outputs))) {}

// gain (W x - mean) + bias with gain = weight / sqrt(variance + epsilon) is one convolution.
Convolution NormedConvolution::folded() const {
  const torch::NoGradGuard no_gradient;
  const torch::Tensor gain =
      norm_->weight * torch::rsqrt(norm_->running_var.to(torch::kDouble) + norm_->options.eps());
  const torch::Tensor weights = convolution_->weight * gain.view({-1, 1, 1, 1});
  const torch::Tensor biases = norm_->bias - gain * norm_->running_mean;
  return {plan_, numbers_of(weights.to(torch::kFloat)), numbers_of(biases.to(torch::kFloat))};
}

torch::Tensor contrastive_loss(const torch::Tensor& codes,
                               std::span<const std::uint8_t> other_places, double temperature) {
  constexpr double kShortest = 1e-9;  // a constant code has NCC 0
  constexpr double kImpossible = -1e4;
  const std::int64_t num_pairs = codes.size(0) / 2;
  core::require(other_places.size() == static_cast<std::size_t>(num_pairs * num_pairs),
                "of every two pairs it is known whether they may be set against each other");
  const torch::Tensor may =
      torch::from_blob(const_cast<std::uint8_t*>(other_places.data()),  // NOLINT: never written
                       {num_pairs, num_pairs}, torch::kUInt8)
          .to(torch::kBool);
  const torch::Tensor deviations = codes - codes.mean(1, true);
  const torch::Tensor unit = deviations / deviations.norm(2, 1, true).clamp_min(kShortest);
  const torch::Tensor ncc =
      torch::matmul(unit.slice(0, 0, num_pairs), unit.slice(0, num_pairs).t()) / temperature;
  const torch::Tensor is_out = torch::logical_not(may | torch::eye(num_pairs, torch::kBool));
  const torch::Tensor scores = ncc.masked_fill(is_out, kImpossible);
  const torch::Tensor forth = torch::log_softmax(scores, 1).diagonal();
  const torch::Tensor back = torch::log_softmax(scores, 0).diagonal();
  return -(forth + back).mean() / 2;
}

std::string state_of(const torch::nn::Module& layers, const torch::optim::Adam& adam) {
  torch::serialize::OutputArchive archive;
  torch::serialize::OutputArchive of_layers;
  torch::serialize::OutputArchive of_adam;
  layers.save(of_layers);
  adam.save(of_adam);
  archive.write("layers", of_layers);
  archive.write("adam", of_adam);
  std::ostringstream bytes;
  archive.save_to(bytes);
  return bytes.str();
}

void restore_state(const std::string& state, torch::nn::Module& layers, torch::optim::Adam& adam) {
  try {
    torch::serialize::InputArchive archive;
    torch::serialize::InputArchive of_layers;
    torch::serialize::InputArchive of_adam;
    archive.load_from(state.data(), state.size());
    archive.read("layers", of_layers);
    archive.read("adam", of_adam);
    layers.load(of_layers);
    adam.load(of_adam);
  } catch (const c10::Error& error) {
    throw core::InputError(std::string("no state of a network: ") + error.what_without_backtrace());
  }
}

void step_down(const torch::Tensor& error, double learning_rate, torch::optim::Adam& adam) {
  for (auto& group : adam.param_groups()) group.options().set_lr(learning_rate);
  adam.zero_grad();
  error.backward();
  adam.step();
}

}  // namespace samewhere::train
