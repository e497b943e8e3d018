#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/ordered_workers.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/train/trainer.hpp>

namespace samewhere::train {
namespace {

using core::InputError;

constexpr std::size_t kNumChecked = 16;  // views that trained and exported network are compared on

std::uint64_t seed_of(const Config& config) { return static_cast<std::uint64_t>(config.seed); }

std::vector<std::vector<int>> cut(const std::vector<int>& order, int batch) {
  std::vector<std::vector<int>> batches;
  for (std::size_t start = 0; start < order.size(); start += static_cast<std::size_t>(batch)) {
    const std::size_t end = std::min(order.size(), start + static_cast<std::size_t>(batch));
    batches.emplace_back(order.begin() + static_cast<std::ptrdiff_t>(start),
                         order.begin() + static_cast<std::ptrdiff_t>(end));
  }
  return batches;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    lines.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return lines;
}

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

// One setting a line.
void check_settings(const std::filesystem::path& checkpoint, const std::string& found,
                    const std::string& expected) {
  const std::vector<std::string> theirs = lines_of(found);
  const std::vector<std::string> ours = lines_of(expected);
  for (std::size_t i = 0; i < std::max(theirs.size(), ours.size()); ++i) {
    const std::string their = i < theirs.size() ? theirs[i] : "nothing";
    const std::string our = i < ours.size() ? ours[i] : "nothing";
    if (their == our) continue;
    throw InputError(fmt::format(
        "{}: was made with {}, this command says {}; give the same settings, or remove it to begin "
        "anew",
        checkpoint.string(), their, our));
  }
}

}  // namespace

Trainer::Trainer(const Config& config, const ImageSet& images, std::filesystem::path checkpoint,
                 const std::string& commit)
    : config_(config),
      checkpoint_path_(std::move(checkpoint)),
      plan_(plan_network(config)),
      split_(split_views(images, seed_of(config))),
      examples_(config, images.views,
                scale_of_targets(images.views, split_.training, config.target)),
      state_{.settings = settings_text(config),
             .network = layers_text(plan_),
             .images_sha256 = images.sha256,
             .commits = {commit}},
      autoencoder_(plan_, seed_of(config)) {
  if (is_there(checkpoint_path_)) resume(commit);
}

void Trainer::resume(const std::string& commit) {
  Checkpoint found = read_checkpoint(checkpoint_path_);
  check_settings(checkpoint_path_, found.settings, state_.settings);
  if (found.network != state_.network) {
    throw InputError(fmt::format(
        "{}: was made by commit {} with another network ({}), this program has {}; go on with that "
        "one, or remove it to begin anew",
        checkpoint_path_.string(), fmt::join(found.commits, ", "), found.network, state_.network));
  }
  if (found.images_sha256 != state_.images_sha256) {
    throw InputError(checkpoint_path_.string() +
                     ": was made with other images; give the same --images, or remove it to begin "
                     "anew");
  }
  autoencoder_.restore(found.autoencoder);
  state_ = std::move(found);
  if (state_.commits.back() != commit) state_.commits.push_back(commit);
}

EpochFigures Trainer::best_epoch() const {
  core::require(!history().empty(), "the best epoch is one of those done");
  return *std::min_element(history().begin(), history().end(),
                           [](const EpochFigures& a, const EpochFigures& b) {
                             return a.validation_error < b.validation_error;
                           });
}

Encoder Trainer::best_encoder() const { return encoder_with(plan_, state_.best_parameters); }

bool Trainer::is_done() const {
  const int num_done = static_cast<int>(history().size());
  if (num_done == 0) return false;
  return num_done >= config_.epochs || num_done - best_epoch().epoch >= config_.patience;
}

double Trainer::learning_rate(int epoch) const {
  const double done = static_cast<double>(epoch - 1) / config_.epochs;
  return config_.learning_rate * 0.5 * (1.0 + std::cos(std::numbers::pi * done));
}

// A new order each time (Fisher and Yates); a last batch of one is left out, because a
// normalisation over one image says nothing.
std::vector<std::vector<int>> Trainer::training_batches(int epoch) const {
  std::vector<int> order = split_.training;
  core::Random random(core::seed_of(seed_of(config_), "order", static_cast<std::uint64_t>(epoch)));
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.index(i)]);
  std::vector<std::vector<int>> batches = cut(order, config_.batch);
  if (batches.size() > 1 && batches.back().size() == 1) batches.pop_back();
  return batches;
}

void Trainer::require_finite(double error, int epoch) const {
  if (std::isfinite(error)) return;
  throw InputError(fmt::format(
      "learning_rate = {}: the loss is no longer finite in epoch {}, expected a smaller one",
      config_.learning_rate, epoch));
}

std::optional<double> Trainer::learn(int epoch, const std::function<void(int, int)>& on_progress) {
  const std::vector<std::vector<int>> batches = training_batches(epoch);
  const std::uint64_t seed =
      core::seed_of(seed_of(config_), "epoch", static_cast<std::uint64_t>(epoch));
  // pictures are distorted beside the learning
  core::OrderedWorkers<Batch> loader(static_cast<int>(batches.size()), 1, [&](int i) {
    return examples_.batch(batches[static_cast<std::size_t>(i)], seed);
  });
  double sum = 0.0;
  int num_done = 0;
  while (const std::optional<Batch> batch = loader.next()) {
    if (core::is_interrupted()) return std::nullopt;
    sum += batch->num_examples * autoencoder_.learn(*batch, learning_rate(epoch));
    require_finite(sum, epoch);
    num_done += batch->num_examples;
    on_progress(num_done, static_cast<int>(split_.training.size()));
  }
  return sum / num_done;
}

// The same distortions every time, so that epochs can be compared.
double Trainer::validation_error() {
  double sum = 0.0;
  for (const std::vector<int>& indices : cut(split_.validation, config_.batch)) {
    const Batch batch = examples_.batch(indices, core::seed_of(seed_of(config_), "validation", 0));
    sum += batch.num_examples * autoencoder_.error(batch);
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
  EpochFigures figures{.epoch = static_cast<int>(history().size()) + 1};
  const std::optional<double> training_error = learn(figures.epoch, on_progress);
  if (!training_error) return std::nullopt;
  figures.training_error = *training_error;
  figures.validation_error = validation_error();
  require_finite(figures.validation_error, figures.epoch);
  state_.history.push_back(figures);
  state_.autoencoder = autoencoder_.state();
  if (best_epoch().epoch == figures.epoch) {
    state_.best_parameters = parameters_of(autoencoder_.encoder());
    state_.best_codes = checked_codes();
  }
  write_checkpoint(checkpoint_path_, state_);
  return figures;
}

}  // namespace samewhere::train
