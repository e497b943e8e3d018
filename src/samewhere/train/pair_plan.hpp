#pragma once

#include <vector>

#include <samewhere/train/network_plan.hpp>
#include <samewhere/train/pair_config.hpp>

namespace samewhere::train {

// The shape of the network that judges a registered pair: convolutions of stride 2, each followed
// by ReLU, over the planes of verify::PairView; their mean over all positions; and a last
// convolution of that one position, whose sigmoid is how probable it is that both views show one
// place.
std::vector<ConvolutionPlan> plan_pair_network(const PairConfig& config);

// All that is kept of one that has learnt.
struct PairNetwork {
  std::vector<Convolution> convolutions;
};

int num_weights(const PairNetwork& network);

}  // namespace samewhere::train
