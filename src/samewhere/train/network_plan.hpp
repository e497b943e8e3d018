#pragma once

#include <vector>

#include <opencv2/core/types.hpp>

#include <samewhere/train/config.hpp>

namespace samewhere::train {

// One convolution, square kernel. All but the last are followed by ReLU and the maximum of each
// 2 x 2 positions.
struct ConvolutionPlan {
  int num_inputs = 0;  // channels
  int num_outputs = 0;
  int kernel_px = 0;
  int stride_px = 1;
  int padding_px = 0;
};

// The code is the sigmoid of the mean of what the last convolution gives (14 x 19 positions) in
// windows of so many positions a side, so many apart: 4 x 6 of them. No ReLU before it, half of the
// numbers would say nothing; bounded, so that no single one decides; around 0.5, which cosine takes
// for likeness (nothing is lost below the published 0.6) and NCC takes away.
inline constexpr int kCodeWindow = 4;
inline constexpr int kCodeStep = 3;

// Behind the first convolution's maximum each position is divided by sqrt(this + the sum of the
// squares of its channels): what is in the view counts, not how strongly it is lit.
inline constexpr float kResponseFloor = 1.0F;

// The shape of the encoder, after CALC (Merrill and Huang, RSS 2018): three convolutions. The first
// has the stride that brings any input to 62 x 82 positions, so that all later layers, their cost
// and the code are the same whatever the size of the input. The code is row by row within a
// channel.
struct NetworkPlan {
  cv::Size input_px;
  std::vector<ConvolutionPlan> convolutions;
  int code_size = 0;
  int target_size = 0;
};

// Throws InputError if no whole number of channels gives config.code_size.
NetworkPlan plan_network(const Config& config);

// A trained convolution: its plan, and weights in the order output, input, row, column.
struct Convolution {
  ConvolutionPlan plan;
  std::vector<float> weights;
  std::vector<float> biases;  // one per output
};

// All that is kept of an autoencoder: view in, code out.
struct Encoder {
  cv::Size input_px;
  std::vector<Convolution> convolutions;
};

// Length of its code.
int code_size(const Encoder& encoder);

}  // namespace samewhere::train
