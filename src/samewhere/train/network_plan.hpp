#pragma once

#include <vector>

#include <opencv2/core/types.hpp>

#include <samewhere/train/config.hpp>

namespace samewhere::train {

// One convolution, square kernel. All but the last are followed by ReLU.
struct ConvolutionPlan {
  int num_inputs = 0;  // channels
  int num_outputs = 0;
  int kernel_px = 0;
  int stride_px = 1;
  int padding_px = 0;
};

// Behind the first convolution and its ReLU the mean is taken of cells of so many positions a side,
// side by side: 15 x 20 cells of 8 x 8 pixels of an input of 120 x 160. Then each cell is divided
// by sqrt(kResponseFloor + the sum of the squares of its channels): what is in the view counts, not
// how strongly it is lit, and a bare wall counts for little, as in HOG.
inline constexpr int kCellSide = 4;
inline constexpr float kResponseFloor = 1.0F;

// The code is the sigmoid of the mean of what the last convolution gives (15 x 20 cells) in windows
// of so many cells a side, so many apart: 4 x 6 of them. No ReLU before it, half of the numbers
// would say nothing; bounded, so that no single one decides; around 0.5, which cosine takes for
// likeness (nothing is lost below the published 0.6) and NCC takes away.
inline constexpr int kCodeWindow = 5;
inline constexpr int kCodeStep = 3;

// The shape of the encoder: four convolutions. The first sees edges and has the stride that brings
// any input to 60 x 80 positions, so that all later layers, their cost and the code are the same
// whatever the size of the input. The code is row by row within a channel.
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
