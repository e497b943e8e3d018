#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <samewhere/train/pair_examples.hpp>
#include <samewhere/train/pair_plan.hpp>

namespace samewhere::train {

// A convolutional network that learns to tell pairs of one place from pairs that only look alike
// (libtorch, Adam of Kingma and Ba 2015). All but the last convolution are followed by batch
// normalisation, which network() folds into the weights. On one thread the same calls give the same
// bits.
class PairClassifier {
 public:
  // Weights are drawn by `seed`. One that sees no pictures never will: what it makes of a pair does
  // not depend on them, nor on where they are alike, as long as it learns from pairs without.
  PairClassifier(const std::vector<ConvolutionPlan>& plan, std::uint64_t seed, bool sees_pictures);
  PairClassifier(const PairClassifier&) = delete;
  PairClassifier& operator=(const PairClassifier&) = delete;
  ~PairClassifier();

  // One step down the gradient. Returns the weighted mean of the cross entropy before it, in nats:
  // ln 2 for one that knows nothing.
  double learn(const PairBatch& batch, double learning_rate);
  // How probable it is that each pair is of one place; nothing learnt.
  std::vector<float> judge(std::span<const float> planes);

  PairNetwork network() const;

  // All that a later learn() depends on, as bytes; and back into one of the same plan. Throws
  // InputError on foreign bytes.
  std::string state() const;
  void restore(const std::string& state);

 private:
  struct Network;
  std::unique_ptr<Network> network_;
};

}  // namespace samewhere::train
