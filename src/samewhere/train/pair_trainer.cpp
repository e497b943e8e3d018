#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/ordered_workers.hpp>
#include <samewhere/train/pair_trainer.hpp>

namespace samewhere::train {
namespace {

constexpr std::size_t kNumChecked = 16;  // pairs that trained and exported network are compared on

// The number of threads is no setting of the training: it may change the last bits, nothing else.
std::string settings_text(PairConfig config) {
  config.threads = 0;
  return core::config_as_yaml(config);
}

std::string layers_text(const std::vector<ConvolutionPlan>& plan) {
  std::string text = "pairs:";
  for (const ConvolutionPlan& layer : plan) {
    text += fmt::format(" {}x{}x{} stride {} padding {},", layer.num_outputs, layer.num_inputs,
                        layer.kernel_px, layer.stride_px, layer.padding_px);
  }
  return text;
}

// Weighted cross entropy, summed, in nats.
double error_of(const PairBatch& batch, const std::vector<float>& answers) {
  double sum = 0.0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    constexpr double kLeast = 1e-7;  // of a float that is nearly 0 or 1 little is known
    const double same = std::clamp(static_cast<double>(answers[i]), kLeast, 1.0 - kLeast);
    sum -= batch.weights[i] * std::log(batch.is_same[i] > 0.5F ? same : 1.0 - same);
  }
  return sum;
}

}  // namespace

PairTrainer::PairTrainer(const PairConfig& config, const PairSet& set,
                         std::filesystem::path checkpoint, const std::string& commit)
    : config_(config),
      set_(set),
      plan_(plan_pair_network(config)),
      training_(pairs_of(set, false)),
      validation_(pairs_of(set, true)),
      examples_(config, set),
      run_(schedule_of(config),
           {.settings = settings_text(config),
            .network = layers_text(plan_),
            .images_sha256 = set.sha256,
            .commits = {commit}},
           std::move(checkpoint), "sources"),
      classifier_(plan_, static_cast<std::uint64_t>(config.seed), config.hidden_pictures < 1.0) {
  if (!history().empty()) classifier_.restore(run_.state().learner);
}

PairNetwork PairTrainer::best_network() const {
  return {convolutions_with(plan_, run_.state().best_parameters)};
}

std::optional<double> PairTrainer::learn(const std::function<void(int, int)>& on_progress) {
  const std::vector<std::vector<int>> batches = run_.batches(training_);
  const std::uint64_t seed = run_.epoch_seed();
  // pairs are distorted beside the learning
  core::OrderedWorkers<PairBatch> loader(static_cast<int>(batches.size()), 1, [&](int i) {
    return examples_.distorted(batches[static_cast<std::size_t>(i)], seed);
  });
  double sum = 0.0;
  int num_done = 0;
  while (const std::optional<PairBatch> batch = loader.next()) {
    if (core::is_interrupted()) return std::nullopt;
    sum += batch->num_examples * classifier_.learn(*batch, run_.learning_rate());
    run_.require_finite(sum);
    num_done += batch->num_examples;
    on_progress(num_done, num_training());
  }
  return sum / num_done;
}

double PairTrainer::validation_error() {
  double sum = 0.0;
  for (const std::vector<int>& indices : cut(validation_, config_.batch)) {
    const PairBatch batch = examples_.plain(indices);
    sum += error_of(batch, classifier_.judge(batch.planes));
  }
  return sum / num_validation();
}

std::vector<cv::Mat> PairTrainer::checked_planes() const {
  const std::size_t num_checked = std::min(kNumChecked, validation_.size());
  std::vector<cv::Mat> planes;
  for (std::size_t i = 0; i < num_checked; ++i) {
    const int index = validation_[i * validation_.size() / num_checked];
    planes.push_back(unpacked(set_.pairs[static_cast<std::size_t>(index)].planes));
  }
  return planes;
}

std::optional<EpochFigures> PairTrainer::run_epoch(
    const std::function<void(int, int)>& on_progress) {
  EpochFigures figures{.epoch = run_.epoch()};
  const std::optional<double> training_error = learn(on_progress);
  if (!training_error) return std::nullopt;
  figures.training_error = *training_error;
  figures.validation_error = validation_error();
  run_.require_finite(figures.validation_error);
  run_.finish_epoch(figures, classifier_.state(), [&] {
    TrainingRun::Kept kept{.parameters = parameters_of(classifier_.network().convolutions),
                           .codes = {}};
    for (const cv::Mat& planes : checked_planes())
      kept.codes.push_back(classifier_.judge({planes.ptr<float>(), planes.total()}).front());
    return kept;
  });
  return figures;
}

evaluate::Separation PairTrainer::separation(
    const std::function<double(const cv::Mat&)>& judge) const {
  std::vector<double> of_true;
  std::vector<double> of_wrong;
  for (const int index : validation_) {
    const PairExample& pair = set_.pairs[static_cast<std::size_t>(index)];
    (pair.is_same ? of_true : of_wrong).push_back(judge(unpacked(pair.planes)));
  }
  return evaluate::separation_of(std::move(of_true), std::move(of_wrong));
}

}  // namespace samewhere::train
