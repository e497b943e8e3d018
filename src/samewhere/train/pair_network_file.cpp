#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/network/inference.hpp>
#include <samewhere/train/onnx_file.hpp>
#include <samewhere/train/pair_network_file.hpp>
#include <samewhere/train/sha256.hpp>

namespace samewhere::train {
namespace {

constexpr double kMaxExportError = 1e-5;

constexpr const char* kPreparation =
    "the planes of verify::PairView, one below the other: query, match, seen by both, features "
    "that "
    "agree, only the query's, only the match's, alike";

OrderedJson sources_as_json(const PairSet& set, bool is_held_back) {
  OrderedJson sources = OrderedJson::array();
  for (const PairSource& source : set.sources) {
    if (source.is_held_back != is_held_back) continue;
    sources.push_back({{"source", source.source},
                       {"num_same", source.num_same},
                       {"num_wrong", source.num_wrong}});
  }
  return sources;
}

OrderedJson layers_as_json(const std::vector<ConvolutionPlan>& plan) {
  OrderedJson layers = OrderedJson::array();
  for (std::size_t i = 0; i + 1 < plan.size(); ++i)
    layers.push_back(layer_text(plan[i]) + ", ReLU");
  layers.push_back("mean of all positions");
  layers.push_back(layer_text(plan.back()) + ", sigmoid");
  return layers;
}

OrderedJson card_for(const PairJob& job, const PairSet& set, const PairTrainer& trainer,
                     const PairQuality& quality, const std::string& bytes) {
  const evaluate::Separation& separation = quality.separation;
  return {{"network", job.out.filename().string()},
          {"sha256", sha256_of(bytes)},
          {"num_bytes", bytes.size()},
          {"num_weights", num_weights(trainer.best_network())},
          {"command", job.command},
          {"version", job.version},
          {"commits", trainer.commits()},
          {"settings", settings_as_json(core::config_as_yaml(job.config))},
          {"pairs",
           {{"sources", sources_as_json(set, false)},
            {"validation_sources", sources_as_json(set, true)},
            {"num_training", trainer.num_training()},
            {"num_validation", trainer.num_validation()},
            {"sha256_of_prepared_pairs", set.sha256}}},
          {"input",
           {{"name", "planes"},
            {"shape", {1, 1, verify::kNumPairPlanes * verify::kPairSide_px, verify::kPairSide_px}},
            {"preparation", kPreparation}}},
          {"output", {{"name", "same"}, {"shape", {1, 1}}}},
          {"layers", layers_as_json(trainer.plan())},
          {"best_epoch", quality.best.epoch},
          {"validation",
           {{"error", quality.best.validation_error},
            {"auc", separation.auc},
            {"kept_at_1_percent_wrong", separation.kept_at_1_percent},
            {"num_same", separation.num_true},
            {"num_wrong", separation.num_wrong}}},
          {"epochs", epochs_as_json(trainer.history())}};
}

// A network that learning has ruined: that is the settings' fault.
void require_usable(std::span<const float> answers, const PairConfig& config) {
  const bool is_finite =
      std::all_of(answers.begin(), answers.end(), [](float x) { return std::isfinite(x); });
  const auto [least, most] = std::minmax_element(answers.begin(), answers.end());
  if (is_finite && (answers.size() < 2 || *least < *most)) return;
  throw core::InputError(
      fmt::format("learning_rate = {}: the best network answers {}, expected a smaller one",
                  config.learning_rate, is_finite ? "the same to all pairs" : "no finite number"));
}

double export_error(network::Inference& exported, const PairTrainer& trainer) {
  const std::vector<cv::Mat> planes = trainer.checked_planes();
  double worst = 0.0;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const double answer = exported.run(planes[i]).at(0);
    worst = std::max(worst, std::abs(answer - trainer.best_answers()[i]));
  }
  return worst;
}

// What prepared pairs depend on.
std::string made_of(const PairJob& job) {
  const PairConfig& config = job.config;
  return fmt::format("sources {}; validate {}; step {}, window {}, matches {}, cameras {}; {}",
                     fmt::join(job.sources, " "), fmt::join(job.validate, " "), config.step,
                     config.window_frames, config.min_matches, config.other_cameras, job.version);
}

}  // namespace

PairSet prepared_pairs(const PairJob& job) {
  if (job.prepared.empty()) return read_pairs(job.sources, job.validate, job.config);
  if (is_there(job.prepared)) return load_pairs(job.prepared, made_of(job));
  PairSet set = read_pairs(job.sources, job.validate, job.config);
  write_pairs(job.prepared, set, made_of(job));
  return set;
}

PairQuality write_pair_network(const PairJob& job, const PairSet& set, const PairTrainer& trainer) {
  require_usable(trainer.best_answers(), job.config);
  const std::string bytes = onnx_bytes(trainer.best_network(), kPreparation);
  const auto exported = network::make_inference(network::parse_network(job.out, bytes));
  core::require(export_error(*exported, trainer) <= kMaxExportError,
                "the exported network gives the answers of the trained one");
  const PairQuality quality{.best = trainer.best_epoch(),
                            .separation = trainer.separation([&](const cv::Mat& planes) {
                              return exported->run(planes).at(0);
                            })};
  write_with_card(job.out, bytes, card_for(job, set, trainer, quality, bytes));
  return quality;
}

}  // namespace samewhere::train
