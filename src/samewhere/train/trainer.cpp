#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/ordered_workers.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/train/trainer.hpp>

namespace samewhere::train {
namespace {

constexpr std::size_t kNumChecked = 16;  // views that trained and exported network are compared on

std::uint64_t seed_of(const Config& config) { return static_cast<std::uint64_t>(config.seed); }

// The number of threads is no setting of the training: it may change the last bits, nothing else.
std::string settings_text(Config config) {
  config.threads = 0;
  return core::config_as_yaml(config);
}

// Outputs x inputs x side of each kernel, its stride and padding.
std::string layers_text(const NetworkPlan& plan) {
  std::string text = fmt::format("input {}x{}, ", plan.input_px.height, plan.input_px.width);
  for (const ConvolutionPlan& layer : plan.convolutions) {
    text += fmt::format("{}x{}x{} stride {} padding {}, ", layer.num_outputs, layer.num_inputs,
                        layer.kernel_px, layer.stride_px, layer.padding_px);
  }
  return text + fmt::format("code {}, target {}", plan.code_size, plan.target_size);
}

}  // namespace

Trainer::Trainer(const Config& config, const ImageSet& images, std::filesystem::path checkpoint,
                 const std::string& commit)
    : config_(config),
      plan_(plan_network(config)),
      split_(split_views(images, seed_of(config))),
      examples_(config, images, split_,
                scale_of_targets(images.views, split_.training, config.target)),
      run_(schedule_of(config),
           {.settings = settings_text(config),
            .network = layers_text(plan_),
            .images_sha256 = images.sha256,
            .commits = {commit}},
           std::move(checkpoint), "--images"),
      autoencoder_(plan_, seed_of(config),
                   {.weight = config.contrast, .temperature = config.temperature}) {
  if (!history().empty()) autoencoder_.restore(run_.state().learner);
}

Encoder Trainer::best_encoder() const {
  return {plan_.input_px, convolutions_with(plan_.convolutions, run_.state().best_parameters)};
}

std::optional<double> Trainer::learn(const std::function<void(int, int)>& on_progress) {
  const std::vector<std::vector<int>> batches = run_.batches(split_.training);
  const std::uint64_t seed = run_.epoch_seed();
  // pictures are distorted beside the learning
  core::OrderedWorkers<Batch> loader(static_cast<int>(batches.size()), 1, [&](int i) {
    return examples_.batch(batches[static_cast<std::size_t>(i)], seed);
  });
  double sum = 0.0;
  int num_done = 0;
  std::size_t index = 0;
  while (const std::optional<Batch> batch = loader.next()) {
    if (core::is_interrupted()) return std::nullopt;
    const auto num_images = static_cast<int>(batches[index].size());
    sum += num_images * autoencoder_.learn(*batch, run_.learning_rate());
    run_.require_finite(sum);
    num_done += num_images;
    ++index;
    on_progress(num_done, static_cast<int>(split_.training.size()));
  }
  return sum / num_done;
}

// The same distortions every time, so that epochs can be compared.
double Trainer::validation_error() {
  double sum = 0.0;
  for (const std::vector<int>& indices : cut(split_.validation, config_.batch)) {
    const Batch batch = examples_.batch(indices, core::seed_of(seed_of(config_), "validation", 0));
    sum += static_cast<double>(indices.size()) * autoencoder_.error(batch);
  }
  return sum / static_cast<double>(split_.validation.size());
}

// Spread over the validation views.
std::vector<cv::Mat> Trainer::checked_inputs() const {
  const std::size_t num_views = split_.validation.size();
  const std::size_t num_checked = std::min(kNumChecked, num_views);
  std::vector<cv::Mat> inputs;
  for (std::size_t i = 0; i < num_checked; ++i) {
    inputs.push_back(examples_.input(split_.validation[i * num_views / num_checked]));
  }
  return inputs;
}

std::vector<float> Trainer::checked_codes() {
  std::vector<float> codes;
  for (const cv::Mat& input : checked_inputs()) {
    const std::vector<float> code = autoencoder_.encode({input.ptr<float>(), input.total()});
    codes.insert(codes.end(), code.begin(), code.end());
  }
  return codes;
}

std::optional<EpochFigures> Trainer::run_epoch(const std::function<void(int, int)>& on_progress) {
  EpochFigures figures{.epoch = run_.epoch()};
  const std::optional<double> training_error = learn(on_progress);
  if (!training_error) return std::nullopt;
  figures.training_error = *training_error;
  figures.validation_error = validation_error();
  run_.require_finite(figures.validation_error);
  run_.finish_epoch(figures, autoencoder_.state(), [&] {
    return TrainingRun::Kept{parameters_of(autoencoder_.encoder().convolutions), checked_codes()};
  });
  return figures;
}

}  // namespace samewhere::train
