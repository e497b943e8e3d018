#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <samewhere/train/examples.hpp>
#include <samewhere/train/network_plan.hpp>

namespace samewhere::train {

// How much it counts that views of one place have like codes, those of other places unlike ones.
struct ContrastConfig {
  double weight = 0.0;
  double temperature = 0.07;
};

// A convolutional encoder and a linear decoder that learn together (libtorch, Adam of Kingma and Ba
// 2015). Each convolution is followed by batch normalisation (Ioffe and Szegedy 2015), which
// encoder() folds into its weights. On one thread the same calls give the same bits.
class Autoencoder {
 public:
  // Weights are drawn by `seed`.
  Autoencoder(const NetworkPlan& plan, std::uint64_t seed, const ContrastConfig& contrast = {});
  Autoencoder(const Autoencoder&) = delete;
  Autoencoder& operator=(const Autoencoder&) = delete;
  ~Autoencoder();

  // One step down the gradient. Returns the loss before it: the mean squared error in shares of the
  // targets' variance (TargetScale) and, of a batch with pairs, weight x contrastive_loss().
  double learn(const Batch& batch, double learning_rate);
  // The same loss, nothing learnt.
  double error(const Batch& batch);
  // Codes of inputs one after the other.
  std::vector<float> encode(std::span<const float> inputs);

  Encoder encoder() const;

  // All that a later learn() depends on, as bytes; and back into one of the same plan. Throws
  // InputError on foreign bytes.
  std::string state() const;
  void restore(const std::string& state);

 private:
  struct Network;
  std::unique_ptr<Network> network_;
};

// Threads for everything in libtorch and OpenBLAS from now on, at least 1.
void set_num_threads(int num_threads);

// How to get a fast linear algebra library; empty if there is one.
std::string advice_on_linear_algebra();

}  // namespace samewhere::train
