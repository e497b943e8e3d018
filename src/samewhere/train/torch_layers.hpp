#pragma once

// What the networks that learn share of libtorch; only they include this.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <torch/nn/modules/batchnorm.h>
#include <torch/nn/modules/conv.h>
#include <torch/optim/adam.h>
#include <torch/types.h>

#include <samewhere/train/network_plan.hpp>

namespace samewhere::train {

// Views the numbers, copies nothing.
torch::Tensor tensor_of(std::span<const float> numbers, at::IntArrayRef shape);
std::vector<float> numbers_of(const torch::Tensor& tensor);

// A convolution, and the batch normalisation behind it.
class NormedConvolution : public torch::nn::Module {
 public:
  explicit NormedConvolution(const ConvolutionPlan& plan);

  torch::Tensor forward(const torch::Tensor& x) { return norm_(convolution_(x)); }
  torch::nn::BatchNorm2d& norm() { return norm_; }
  torch::Tensor& weight() { return convolution_->weight; }
  // Both as one convolution.
  Convolution folded() const;

 private:
  ConvolutionPlan plan_;
  torch::nn::Conv2d convolution_;
  torch::nn::BatchNorm2d norm_;
};

// InfoNCE (van den Oord et al. 2018) over NCC: how badly the code of one view of a pair finds the
// other among those of other places, in both directions, mean over pairs. `codes`: 2n rows, pair i
// is rows i and n + i. `other_places`: n x n, 1 where pairs i and j may be set against each other.
torch::Tensor contrastive_loss(const torch::Tensor& codes,
                               std::span<const std::uint8_t> other_places, double temperature);

// Layers and Adam as bytes; and back into those of the same shape. Throws InputError on foreign
// bytes.
std::string state_of(const torch::nn::Module& layers, const torch::optim::Adam& adam);
void restore_state(const std::string& state, torch::nn::Module& layers, torch::optim::Adam& adam);

// One step down the gradient of `error`.
void step_down(const torch::Tensor& error, double learning_rate, torch::optim::Adam& adam);

}  // namespace samewhere::train
