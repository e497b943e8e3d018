#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/checksum.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/features/orb.hpp>
#include <samewhere/input/prefetch.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/run/vocabulary_training.hpp>

namespace samewhere::run {
namespace {

using Json = nlohmann::ordered_json;

// The descriptors of one picture of `step`, a matrix each.
std::vector<cv::Mat> descriptors_of(const pipeline::Config& config, int step) {
  const auto source = input::prefetched(open_source(config));
  core::Progress progress(config.source, source->info().num_frames);
  std::vector<cv::Mat> pictures;
  for (int i = 0; const std::optional<core::Frame> frame = source->next(); ++i) {
    if (core::is_interrupted()) throw core::Interrupted();
    if (i % step == 0)
      pictures.push_back(features::extract(*frame, config.features).features->descriptors);
    progress.update(i + 1);
  }
  return pictures;
}

std::string card_of(const VocabularyTraining& training, const TrainedVocabulary& trained,
                    const Json& sources) {
  const Json card = {
      {"vocabulary", training.out.filename().string()},
      {"checksum",
       fmt::format("{:016x}", core::checksum(core::read_file(training.out, core::kNetworkLimit)))},
      {"command", training.command},
      {"sources", sources},
      {"num_pictures", trained.num_pictures},
      {"num_features", trained.num_features},
      {"num_words", trained.num_words}};
  return card.dump(2) + "\n";
}

}  // namespace

TrainedVocabulary train_vocabulary(const VocabularyTraining& training,
                                   const pipeline::Config& config) {
  std::vector<cv::Mat> pictures;
  Json sources = Json::array();
  for (const std::string& name : training.sources) {
    pipeline::Config of_source = config;
    of_source.source = absolute_source(name);
    const std::vector<cv::Mat> found = descriptors_of(of_source, training.step);
    sources.push_back({{"source", name}, {"num_pictures", found.size()}});
    pictures.insert(pictures.end(), found.begin(), found.end());
  }
  TrainedVocabulary trained{.num_pictures = static_cast<int>(pictures.size())};
  for (const cv::Mat& descriptors : pictures) trained.num_features += descriptors.rows;
  if (trained.num_features == 0)
    throw core::InputError(training.sources.front() + ": no picture has a feature to learn from");
  const features::Vocabulary vocabulary = grow_vocabulary(pictures, training.grow);
  trained.num_words = vocabulary.num_words();
  save_vocabulary(vocabulary, training.out);
  const std::filesystem::path card = std::filesystem::path(training.out).replace_extension(".json");
  core::write_file(card, card_of(training, trained, sources));
  return trained;
}

}  // namespace samewhere::run
