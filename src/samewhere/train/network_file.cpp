#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/train/network_file.hpp>
#include <samewhere/train/onnx_file.hpp>
#include <samewhere/train/onnx_runner.hpp>
#include <samewhere/train/sha256.hpp>
#include <samewhere/train/validation.hpp>

namespace samewhere::train {
namespace {

using json = nlohmann::ordered_json;

constexpr double kMaxExportError = 1e-5;
constexpr std::size_t kNumChecked = 16;  // views that trained and exported network are compared on

constexpr const char* kPreparation =
    "grey, 360 rows x 480 columns, histogram equalisation, reduced by averaging over the area, "
    "divided by 255";

// "key: value" lines.
json settings_as_json(const Config& config) {
  json settings;
  std::istringstream lines(core::config_as_yaml(config));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) settings[line.substr(0, colon)] = line.substr(colon + 2);
  }
  return settings;
}

json layers_as_json(const NetworkPlan& plan) {
  json layers = json::array();
  for (std::size_t i = 0; i < plan.convolutions.size(); ++i) {
    const ConvolutionPlan& convolution = plan.convolutions[i];
    layers.push_back(
        fmt::format("convolution {0} x {0}, {1} to {2} channels, stride {3}, padding {4}",
                    convolution.kernel_px, convolution.num_inputs, convolution.num_outputs,
                    convolution.stride_px, convolution.padding_px));
    layers.push_back(i + 1 < plan.convolutions.size() ? "ReLU, maximum 2 x 2" : "ReLU");
  }
  layers.push_back(fmt::format("mean {0} x {0}, stride {1}", kCodeWindow, kCodeStep));
  return layers;
}

json images_as_json(const ImageSet& images, const Split& split) {
  json sources = json::array();
  for (const SourceCount& source : images.sources) {
    sources.push_back({{"source", source.source},
                       {"num_images", source.num_images},
                       {"num_unreadable", source.num_unreadable}});
  }
  return {{"sources", sources},
          {"num_training", split.training.size()},
          {"num_validation", split.validation.size()},
          {"sha256_of_prepared_pixels", images.sha256}};
}

json epochs_as_json(const std::vector<EpochFigures>& history) {
  json epochs = json::array();
  for (const EpochFigures& epoch : history) {
    epochs.push_back({{"epoch", epoch.epoch},
                      {"training_error", epoch.training_error},
                      {"validation_error", epoch.validation_error}});
  }
  return epochs;
}

std::string card_text(const Job& job, const ImageSet& images, const Trainer& trainer,
                      const Quality& quality, const std::string& bytes) {
  const NetworkPlan& plan = trainer.plan();
  const json card = {{"network", job.out.filename().string()},
                     {"sha256", sha256_of(bytes)},
                     {"num_bytes", bytes.size()},
                     {"command", job.command},
                     {"version", job.version},
                     {"commit", job.commit},
                     {"settings", settings_as_json(job.config)},
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
  // names of files may hold any bytes
  return card.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

std::filesystem::path beside(const std::filesystem::path& network, const char* ending) {
  std::filesystem::path path = network;
  return path.replace_extension(ending);
}

}  // namespace

std::filesystem::path checkpoint_of(const std::filesystem::path& network) {
  return beside(network, ".checkpoint");
}

std::filesystem::path card_of(const std::filesystem::path& network) {
  return beside(network, ".json");
}

double export_error(Autoencoder& autoencoder, const ImageSet& images, const Config& config) {
  OnnxRunner runner(onnx_bytes(autoencoder.encoder(), ""));
  double worst = 0.0;
  for (std::size_t i = 0; i < std::min(kNumChecked, images.views.size()); ++i) {
    const cv::Mat input = encoder_input(images.views[i], config.input_size);
    const std::vector<float> trained = autoencoder.encode({input.ptr<float>(), input.total()});
    const std::vector<float> exported = runner.encode(input);
    const double difference = cv::norm(trained, exported, cv::NORM_INF);
    worst = std::max(worst, difference / cv::norm(trained, cv::NORM_INF));
  }
  return worst;
}

Quality write_network(const Job& job, const ImageSet& images, Trainer& trainer) {
  core::require(export_error(trainer.autoencoder(), images, job.config) <= kMaxExportError,
                "the exported network gives the codes of the trained one");
  const std::string bytes = onnx_bytes(trainer.best_encoder(), kPreparation);
  OnnxRunner runner(bytes);
  const Split& split = trainer.split();
  const Quality quality{
      .best = trainer.best_epoch(),
      .recognition = recognition(images, split, job.config,
                                 [&](const cv::Mat& input) { return runner.encode(input); }),
      .recognition_of_hog = recognition(images, split, job.config, hog_of_input)};
  core::write_file(job.out, bytes);
  core::write_file(card_of(job.out), card_text(job, images, trainer, quality, bytes));
  std::filesystem::remove(checkpoint_of(job.out));
  return quality;
}

}  // namespace samewhere::train
