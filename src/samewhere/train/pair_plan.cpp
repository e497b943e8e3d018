#include <samewhere/train/pair_plan.hpp>
#include <samewhere/verify/pair_view.hpp>

namespace samewhere::train {

std::vector<ConvolutionPlan> plan_pair_network(const PairConfig& config) {
  const int c = config.channels;
  return {{verify::kNumPairPlanes, c, 5, 2, 2},
          {c, 2 * c, 3, 2, 1},
          {2 * c, 3 * c, 3, 2, 1},
          {3 * c, 4 * c, 3, 2, 1},
          {4 * c, 4 * c, 3, 2, 1},
          {4 * c, 1, 1, 1, 0}};
}

int num_weights(const PairNetwork& network) {
  std::size_t count = 0;
  for (const Convolution& convolution : network.convolutions)
    count += convolution.weights.size() + convolution.biases.size();
  return static_cast<int>(count);
}

}  // namespace samewhere::train
