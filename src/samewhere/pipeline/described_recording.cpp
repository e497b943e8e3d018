#include <filesystem>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/input/prefetch.hpp>
#include <samewhere/pipeline/described_recording.hpp>
#include <samewhere/pipeline/open_source.hpp>

namespace samewhere::pipeline {
namespace {

constexpr const char* kHogName = "hog";

std::string network_name(const std::string& file) {
  return std::filesystem::path(file).stem().string();
}

std::string configured_name(const describe::Config& config) {
  return config.method == describe::Method::kHog ? kHogName : network_name(config.network);
}

NamedDescriber named_describer(const std::string& word, describe::Config config) {
  if (!word.empty()) {
    config.method = word == kHogName ? describe::Method::kHog : describe::Method::kAutoencoder;
    if (word != kHogName) config.network = word;
  }
  return {configured_name(config), describe::make_describer(config)};
}

std::vector<std::string> split_at_commas(const std::string& list) {
  std::vector<std::string> words(1);
  for (const char c : list) {
    if (c == ',') {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

core::Truth place_truth(const core::Source& source, const Config& config) {
  core::Truth truth = source.truth();
  if (!truth.places) {
    throw core::InputError(fmt::format(
        "{}: nothing says which of its frames show the same place; expected same_place.pgm or "
        "same_place.txt beside the images, or a twin building of a short walk",
        config.source));
  }
  return truth;
}

void describe_frame(const core::Frame& frame, const NamedDescriber& by, DescribedViews& views) {
  core::Timings timings;
  {
    const core::ScopedTimer timer(timings, "describe");
    views.views.push_back(by.describer->describe(frame.id, frame.images.front()));
  }
  views.durations_ms.push_back(timings.durations_ms().at("describe").front());
}

// The spec tells two twins of one preset apart; the name of a folder is enough for a recording.
std::string recording_name(const Config& config, const core::SourceInfo& info) {
  constexpr std::string_view kTwin = "twin:";
  return config.source.starts_with(kTwin) ? config.source.substr(kTwin.size()) : info.name;
}

}  // namespace

std::vector<NamedDescriber> make_describers(const std::string& list, const Config& config) {
  std::vector<NamedDescriber> describers;
  std::set<std::string> names;
  for (const std::string& word : split_at_commas(list)) {
    if (word.empty() && !list.empty())
      throw core::InputError(
          fmt::format("--describers {}: expected hog or ONNX files, separated by commas", list));
    describers.push_back(named_describer(word, config.describe));
    if (!names.insert(describers.back().name).second) {
      throw core::InputError(
          fmt::format("--describers {}: two are called {}, expected a different name for each",
                      list, describers.back().name));
    }
  }
  return describers;
}

Config with_source(Config config, const std::string& source_at_window) {
  const std::size_t at = source_at_window.rfind('@');
  std::string window = at == std::string::npos ? "" : source_at_window.substr(at + 1);
  const bool is_in_seconds = window.ends_with('s');
  if (is_in_seconds) window.pop_back();
  const bool is_window =
      !window.empty() && window.find_first_not_of("0123456789") == std::string::npos;
  config.source = absolute_source(is_window ? source_at_window.substr(0, at) : source_at_window);
  if (!is_window) return config;
  if (is_in_seconds) core::set_config(config, "retrieve.window_frames=-1");
  const char* key = is_in_seconds ? "retrieve.window_s=" : "retrieve.window_frames=";
  core::set_config(config, key + window);
  return config;
}

void require_place_truth(const Config& config) { place_truth(*open_source(config), config); }

std::optional<DescribedRecording> describe_recording(
    const Config& config, const std::vector<NamedDescriber>& describers) {
  const auto source = input::prefetched(open_source(config));
  const core::SourceInfo info = source->info();
  DescribedRecording recording{
      .name = recording_name(config, info),
      .window_frames = with_window_in_frames(config, info).retrieve.window_frames,
      .truth = place_truth(*source, config),
      .by_describer = {}};
  for (const auto& by : describers) recording.by_describer.push_back({by.name, {}, {}});
  core::Progress progress(recording.name + ": frames described", info.num_frames);
  int num_done = 0;
  while (const std::optional<core::Frame> frame = source->next()) {
    if (core::is_interrupted()) return std::nullopt;
    for (std::size_t i = 0; i < describers.size(); ++i)
      describe_frame(*frame, describers[i], recording.by_describer[i]);
    progress.update(++num_done);
  }
  return recording;
}

}  // namespace samewhere::pipeline
