#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/network/inference.hpp>
#include <samewhere/train/head_file.hpp>
#include <samewhere/train/head_onnx.hpp>
#include <samewhere/train/sha256.hpp>

namespace samewhere::train {
namespace {

constexpr double kMaxHeadError = 1e-3;
constexpr int kNumCheckedViews = 8;

OrderedJson input_of(const network::TrunkSpec& spec, const network::Trunk& trunk) {
  return {{"trunk", spec.file},
          {"layer", spec.layer},
          {"rows", spec.picture.size_px.height},
          {"columns", spec.picture.size_px.width},
          {"colour", spec.picture.colour == network::Colour::kRgb ? "rgb" : "bgr"},
          {"mean", spec.picture.mean},
          {"scale", spec.picture.scale},
          {"checksum_of_trunk", fmt::format("{:016x}", trunk.checksum())}};
}

OrderedJson sources_of(const std::vector<HeadSource>& sources) {
  OrderedJson all = OrderedJson::array();
  for (const HeadSource& source : sources) {
    all.push_back({{"source", source.name},
                   {"num_images", source.num_views() / source.views_per_image},
                   {"num_views", source.num_views()}});
  }
  return all;
}

OrderedJson history_of(const TrainedHead& trained) {
  OrderedJson epochs = OrderedJson::array();
  for (const HeadEpoch& epoch : trained.history)
    epochs.push_back({{"epoch", epoch.epoch}, {"loss", epoch.loss}, {"auc", epoch.auc}});
  return epochs;
}

// The exported head on some views against the trained one.
void require_same(const HeadJob& job, const std::string& bytes, const TrainedHead& trained,
                  const HeadSource& source) {
  const auto exported = network::make_inference(network::parse_network(job.out, bytes));
  HeadNetwork head(job.kind, source.shape, job.config);
  head.restore(trained.weights);
  for (int i = 0; i < std::min(kNumCheckedViews, source.num_views()); ++i) {
    cv::Mat map;
    source.maps[static_cast<std::size_t>(i)].convertTo(map, CV_32F);
    const std::vector<float> wanted = head.codes({map.ptr<float>(), map.total()});
    const int shape[] = {1, source.shape.channels, source.shape.rows, source.shape.columns};
    const std::vector<float> code = exported->run(map.reshape(1, 4, shape));
    core::require(code.size() == wanted.size(), "codes are of one length");
    double largest = 0.0;
    double difference = 0.0;
    for (std::size_t k = 0; k < code.size(); ++k) {
      largest = std::max(largest, std::abs(static_cast<double>(wanted[k])));
      difference = std::max(difference, std::abs(static_cast<double>(wanted[k]) - code[k]));
    }
    core::require(difference <= kMaxHeadError * largest,
                  fmt::format("the exported head gives the trained one's codes ({} of {})",
                              difference, largest));
  }
}

}  // namespace

network::TrunkSpec trunk_of(HeadKind kind) {
  return network::known_trunk(kind == HeadKind::kDarknet ? "darknet" : "mobilenet");
}

void write_head(const HeadJob& job, const TrainedHead& trained,
                const std::vector<HeadSource>& sources, const std::vector<HeadSource>& validation,
                const network::Trunk& trunk) {
  const HeadWeights& weights = trained.weights;
  if (!std::all_of(weights.project_weights.begin(), weights.project_weights.end(),
                   [](float weight) { return std::isfinite(weight); })) {
    throw core::InputError(
        fmt::format("learning_rate = {}: the head has weights that are not finite, expected a "
                    "smaller one",
                    job.config.learning_rate));
  }
  const std::string bytes = head_onnx_bytes(weights);
  require_same(job, bytes, trained, sources.front());
  const OrderedJson card{
      {"network", job.out.filename().string()},
      {"sha256", sha256_of(bytes)},
      {"num_bytes", bytes.size()},
      {"command", job.command},
      {"version", job.version},
      {"commits", {job.commit}},
      {"settings", settings_as_json(core::config_as_yaml(job.config))},
      {"images",
       {{"sources", sources_of(sources)}, {"validation_sources", sources_of(validation)}}},
      {"input", input_of(trunk_of(job.kind), trunk)},
      {"output", {{"name", "code"}, {"shape", {1, weights.code_size}}}},
      {"best_epoch", trained.best.epoch},
      {"validation", {{"auc", trained.best.auc}}},
      {"epochs", history_of(trained)}};
  write_with_card(job.out, bytes, card);
}

}  // namespace samewhere::train
