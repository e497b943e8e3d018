#include <algorithm>
#include <cctype>
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
#include <samewhere/paper/described_recording.hpp>
#include <samewhere/paper/spread.hpp>
#include <samewhere/run/open_source.hpp>

namespace samewhere::paper {
namespace {

constexpr const char* kHogName = "hog";
constexpr int kMaxTimed = 400;

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

core::Truth place_truth(const core::Source& source, const pipeline::Config& config) {
  core::Truth truth = source.truth();
  if (!truth.places) {
    throw core::InputError(fmt::format(
        "{}: nothing says which of its frames show the same place; expected same_place.pgm or "
        "same_place.txt beside the images, or a twin building of a short walk",
        config.source));
  }
  return truth;
}

// A frame whose description is timed at the end.
struct KeptPicture {
  core::FrameId frame;
  cv::Mat picture;
};

std::vector<double> description_times_ms(const std::vector<KeptPicture>& kept,
                                         describe::Describer& describer) {
  constexpr const char* kDescribe = "describe";
  core::Timings timings;
  if (!kept.empty()) describer.describe(kept.front().frame, kept.front().picture);  // warm
  for (const KeptPicture& each : kept) {
    const core::ScopedTimer timer(timings, kDescribe);
    describer.describe(each.frame, each.picture);
  }
  return kept.empty() ? std::vector<double>() : timings.durations_ms().at(kDescribe);
}

// The spec tells two twins of one preset apart; the name of a folder is enough for a recording.
std::string recording_name(const pipeline::Config& config, const core::SourceInfo& info) {
  constexpr std::string_view kTwin = "twin:";
  return config.source.starts_with(kTwin) ? config.source.substr(kTwin.size()) : info.name;
}

OpenRecording open_recording(const pipeline::Config& config) {
  auto source = run::open_source_with_truth(config);
  const core::SourceInfo info = source->info();
  core::Truth truth = place_truth(*source, config);
  return {.config = run::with_window_in_frames(config, info),
          .name = recording_name(config, info),
          .num_frames = info.num_frames,
          .source = std::move(source),
          .truth = std::move(truth)};
}

// Reads all of it; returns the pictures to be timed. Nothing after Ctrl-C.
std::optional<std::vector<KeptPicture>> read_and_describe(
    OpenRecording& recording, const std::vector<NamedDescriber>& describers,
    const SeePicture& also_see, DescribedRecording& described) {
  const int num_timed = std::min(recording.num_frames, kMaxTimed);
  const auto source = input::prefetched(std::move(recording.source));
  core::Progress progress(recording.name + ": frames described", recording.num_frames);
  std::vector<KeptPicture> kept;
  int num_done = 0;
  while (const std::optional<core::Frame> frame = source->next()) {
    if (core::is_interrupted()) return std::nullopt;
    const cv::Mat& picture = frame->images.front();
    for (std::size_t i = 0; i < describers.size(); ++i) {
      described.by_describer[i].views.push_back(
          describers[i].describer->describe(frame->id, picture));
    }
    if (also_see) also_see(picture);
    if (num_spread_on(num_done, recording.num_frames, num_timed) > 0)
      kept.push_back({frame->id, picture.clone()});
    progress.update(++num_done);
  }
  return kept;
}

}  // namespace

std::vector<NamedDescriber> make_describers(const std::string& list,
                                            const pipeline::Config& config) {
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

pipeline::Config with_source(pipeline::Config config, const std::string& source_at_window) {
  const std::size_t at = source_at_window.rfind('@');
  std::string window = at == std::string::npos ? "" : source_at_window.substr(at + 1);
  const bool is_in_seconds = window.ends_with('s');
  if (is_in_seconds) window.pop_back();
  const bool is_window =
      !window.empty() && window.find_first_not_of("0123456789") == std::string::npos;
  config.source =
      run::absolute_source(is_window ? source_at_window.substr(0, at) : source_at_window);
  if (!is_window) return config;
  if (is_in_seconds) core::set_config(config, "retrieve.window_frames=-1");
  const char* key = is_in_seconds ? "retrieve.window_s=" : "retrieve.window_frames=";
  core::set_config(config, key + window);
  return config;
}

std::vector<OpenRecording> open_recordings(const std::vector<pipeline::Config>& configs) {
  std::vector<OpenRecording> recordings;
  std::set<std::string> stems;
  for (const pipeline::Config& config : configs) {
    recordings.push_back(open_recording(config));
    const OpenRecording& last = recordings.back();
    const int window_frames = last.config.retrieve.window_frames;
    if (!stems.insert(file_stem(last.name, window_frames)).second) {
      throw core::InputError(fmt::format(
          "{}: two recordings are called {} with a window of {} frames, expected a different name "
          "or window for each",
          config.source, last.name, window_frames));
    }
  }
  return recordings;
}

std::string file_stem(const std::string& recording, int window_frames) {
  std::string stem = fmt::format("{}-{}", recording, window_frames);
  for (char& c : stem) {
    const bool is_plain =
        std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
    if (!is_plain) c = '-';
  }
  return stem;
}

std::optional<DescribedRecording> describe_recording(OpenRecording recording,
                                                     const std::vector<NamedDescriber>& describers,
                                                     const SeePicture& also_see) {
  DescribedRecording described{.name = recording.name,
                               .window_frames = recording.config.retrieve.window_frames,
                               .truth = std::move(recording.truth),
                               .timed_frames = {},
                               .by_describer = {}};
  for (const auto& by : describers)
    described.by_describer.push_back({by.name, by.describer->checksum(), {}, {}});
  const auto kept = read_and_describe(recording, describers, also_see, described);
  if (!kept) return std::nullopt;
  for (const KeptPicture& each : *kept)
    described.timed_frames.push_back(static_cast<int>(each.frame.index()));
  for (std::size_t i = 0; i < describers.size(); ++i)
    described.by_describer[i].durations_ms = description_times_ms(*kept, *describers[i].describer);
  return described;
}

}  // namespace samewhere::paper
