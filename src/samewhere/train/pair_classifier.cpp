#include <cstddef>

#include <torch/nn/functional/loss.h>
#include <torch/nn/modules/linear.h>
#include <torch/utils.h>

#include <samewhere/train/pair_classifier.hpp>
#include <samewhere/train/torch_layers.hpp>
#include <samewhere/verify/pair_view.hpp>

namespace samewhere::train {
namespace {

using torch::Tensor;
namespace functional = torch::nn::functional;

constexpr double kWeightDecay = 1e-4;

class Layers : public torch::nn::Module {
 public:
  explicit Layers(const std::vector<ConvolutionPlan>& plan) : last_plan_(plan.back()) {
    for (std::size_t i = 0; i + 1 < plan.size(); ++i) {
      convolutions_.push_back(register_module("convolution" + std::to_string(i + 1),
                                              std::make_shared<NormedConvolution>(plan[i])));
    }
    last_ = register_module("last", torch::nn::Linear(last_plan_.num_inputs, 1));
  }

  // Logarithms of the odds.
  Tensor forward(Tensor x) {
    for (const auto& convolution : convolutions_) x = torch::relu(convolution->forward(x));
    return last_(x.mean({2, 3})).flatten();
  }

  // Weights of planes that are 0 in every pair stay what they are: 0 from here on.
  void shut_eyes() {
    const torch::NoGradGuard no_gradient;
    for (const auto plane :
         {verify::PairPlane::kQuery, verify::PairPlane::kMatch, verify::PairPlane::kAlike})
      convolutions_.front()->weight().select(1, static_cast<std::int64_t>(plane)).zero_();
  }

  PairNetwork folded() const {
    PairNetwork network;
    for (const auto& convolution : convolutions_)
      network.convolutions.push_back(convolution->folded());
    network.convolutions.push_back(
        {last_plan_, numbers_of(last_->weight.detach()), numbers_of(last_->bias.detach())});
    return network;
  }

 private:
  ConvolutionPlan last_plan_;
  std::vector<std::shared_ptr<NormedConvolution>> convolutions_;
  torch::nn::Linear last_{nullptr};
};

Tensor planes_of(std::span<const float> numbers) {
  constexpr std::int64_t kSide = verify::kPairSide_px;
  constexpr std::int64_t kPlanes = verify::kNumPairPlanes;
  return tensor_of(numbers, {static_cast<std::int64_t>(numbers.size()) / (kPlanes * kSide * kSide),
                             kPlanes, kSide, kSide});
}

}  // namespace

struct PairClassifier::Network {
  explicit Network(const std::vector<ConvolutionPlan>& plan)
      : layers(plan),
        adam(layers.parameters(), torch::optim::AdamOptions().weight_decay(kWeightDecay)) {}

  Layers layers;
  torch::optim::Adam adam;
};

PairClassifier::PairClassifier(const std::vector<ConvolutionPlan>& plan, std::uint64_t seed,
                               bool sees_pictures) {
  torch::manual_seed(seed);
  network_ = std::make_unique<Network>(plan);
  if (!sees_pictures) network_->layers.shut_eyes();
}

PairClassifier::~PairClassifier() = default;

double PairClassifier::learn(const PairBatch& batch, double learning_rate) {
  network_->layers.train();
  const std::int64_t n = batch.num_examples;
  const Tensor weights = tensor_of(batch.weights, {n});
  const Tensor error = functional::binary_cross_entropy_with_logits(
      network_->layers.forward(planes_of(batch.planes)), tensor_of(batch.is_same, {n}),
      functional::BinaryCrossEntropyWithLogitsFuncOptions().weight(weights));
  step_down(error, learning_rate, network_->adam);
  return error.item().toDouble();
}

std::vector<float> PairClassifier::judge(std::span<const float> planes) {
  const torch::NoGradGuard no_gradient;
  network_->layers.eval();
  return numbers_of(torch::sigmoid(network_->layers.forward(planes_of(planes))));
}

PairNetwork PairClassifier::network() const { return network_->layers.folded(); }

std::string PairClassifier::state() const { return state_of(network_->layers, network_->adam); }

void PairClassifier::restore(const std::string& state) {
  restore_state(state, network_->layers, network_->adam);
}

}  // namespace samewhere::train
