#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/network/inference.hpp>
#include <samewhere/train/network_file.hpp>
#include <samewhere/train/onnx_file.hpp>
#include <samewhere/train/sha256.hpp>
#include <samewhere/train/validation.hpp>

namespace samewhere::train {
namespace {

constexpr double kMaxExportError = 1e-5;

constexpr const char* kPreparation =
    "grey, 360 rows x 480 columns, histogram equalisation, reduced by averaging over the area, "
    "divided by 255";

OrderedJson layers_as_json(const NetworkPlan& plan) {
  OrderedJson layers = OrderedJson::array();
  for (std::size_t i = 0; i < plan.convolutions.size(); ++i) {
    const ConvolutionPlan& convolution = plan.convolutions[i];
    layers.push_back(layer_text(convolution));
    if (i + 1 < plan.convolutions.size()) layers.push_back("ReLU");
    if (i > 0) continue;
    layers.push_back(fmt::format("mean {0} x {0}, stride {0}", kCellSide));
    layers.push_back("each position over sqrt(1 + the sum of its squares)");
  }
  layers.push_back(fmt::format("mean {0} x {0}, stride {1}, sigmoid", kCodeWindow, kCodeStep));
  return layers;
}

OrderedJson sources_as_json(const ImageSet& images, bool is_held_back) {
  OrderedJson sources = OrderedJson::array();
  for (const SourceCount& source : images.sources) {
    if (source.is_held_back != is_held_back) continue;
    sources.push_back({{"source", source.source},
                       {"num_images", source.num_images},
                       {"num_unreadable", source.num_unreadable}});
  }
  return sources;
}

OrderedJson images_as_json(const ImageSet& images, const Split& split) {
  OrderedJson validation_sources = sources_as_json(images, true);
  if (validation_sources.empty()) validation_sources = "blocks of the sources";
  return {{"sources", sources_as_json(images, false)},
          {"validation_sources", validation_sources},
          {"num_training", split.training.size()},
          {"num_validation", split.validation.size()},
          {"sha256_of_prepared_images", images.sha256}};
}

OrderedJson card_for(const Job& job, const ImageSet& images, const Trainer& trainer,
                     const Quality& quality, const std::string& bytes) {
  const NetworkPlan& plan = trainer.plan();
  return {{"network", job.out.filename().string()},
          {"sha256", sha256_of(bytes)},
          {"num_bytes", bytes.size()},
          {"command", job.command},
          {"version", job.version},
          {"commits", trainer.commits()},
          {"settings", settings_as_json(core::config_as_yaml(job.config))},
          {"images", images_as_json(images, trainer.split())},
          {"input",
           {{"name", "image"},
            {"shape", {1, 1, plan.input_px.height, plan.input_px.width}},
            {"preparation", kPreparation}}},
          {"output", {{"name", "code"}, {"shape", {1, plan.code_size}}}},
          {"layers", layers_as_json(plan)},
          {"best_epoch", quality.best.epoch},
          {"validation",
           {{"error", quality.best.validation_error},
            {"recognition", quality.recognition},
            {"recognition_of_hog", quality.recognition_of_hog}}},
          {"epochs", epochs_as_json(trainer.history())}};
}

// In shares of the largest number of the trained code; no finite number if either is not.
double difference(std::span<const float> trained, std::span<const float> exported) {
  core::require(trained.size() == exported.size(), "codes are of one length");
  double largest = 0.0;
  double difference = 0.0;
  for (std::size_t i = 0; i < trained.size(); ++i) {
    const double error = std::abs(static_cast<double>(trained[i]) - exported[i]);
    if (!std::isfinite(error)) return error;
    largest = std::max(largest, std::abs(static_cast<double>(trained[i])));
    difference = std::max(difference, error);
  }
  return difference == 0.0 ? 0.0 : difference / largest;
}

// A network that learning has ruined: that is the settings' fault.
void require_usable(const Encoder& encoder, std::span<const float> codes, const Config& config) {
  const std::vector<float> parameters = parameters_of(encoder.convolutions);
  const bool is_finite = std::all_of(parameters.begin(), parameters.end(),
                                     [](float weight) { return std::isfinite(weight); });
  const bool is_alive =
      std::any_of(codes.begin(), codes.end(), [](float number) { return number != 0.0F; });
  if (is_finite && is_alive) return;
  throw core::InputError(fmt::format(
      "learning_rate = {}: the best network {}, expected a smaller one", config.learning_rate,
      is_finite ? "gives nothing but zeros" : "has weights that are not finite"));
}

}  // namespace

double export_error(network::Inference& exported, std::span<const cv::Mat> inputs,
                    std::span<const float> trained_codes) {
  core::require(!inputs.empty() && trained_codes.size() % inputs.size() == 0,
                "there is one code for each input");
  const std::size_t length = trained_codes.size() / inputs.size();
  double worst = 0.0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const double error =
        difference(trained_codes.subspan(i * length, length), exported.run(inputs[i]));
    if (!std::isfinite(error)) return error;
    worst = std::max(worst, error);
  }
  return worst;
}

Quality write_network(const Job& job, const ImageSet& images, Trainer& trainer) {
  const Encoder encoder = trainer.best_encoder();
  require_usable(encoder, trainer.best_codes(), job.config);
  const std::string bytes = onnx_bytes(encoder, kPreparation);
  const auto exported = network::make_inference(network::parse_network(job.out, bytes));
  core::require(
      export_error(*exported, trainer.checked_inputs(), trainer.best_codes()) <= kMaxExportError,
      "the exported network gives the codes of the trained one");
  const Split& split = trainer.split();
  const Quality quality{
      .best = trainer.best_epoch(),
      .recognition = recognition(images, split, job.config,
                                 [&](const cv::Mat& input) { return exported->run(input); }),
      .recognition_of_hog = recognition(images, split, job.config, hog_of_input)};
  write_with_card(job.out, bytes, card_for(job, images, trainer, quality, bytes));
  return quality;
}

}  // namespace samewhere::train
