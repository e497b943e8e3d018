#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/core/stage_thread.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/input/prefetch.hpp>
#include <samewhere/paper/described_recording.hpp>
#include <samewhere/paper/place_truth.hpp>
#include <samewhere/paper/protocols.hpp>
#include <samewhere/paper/spread.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/twin/front/twin.hpp>

namespace samewhere::paper {
namespace {

constexpr std::string_view kNetworkWord = "autoencoder";  // needs its file
constexpr int kMaxTimed = 400;
constexpr std::string_view kTwin = "twin:";

std::string network_name(const std::string& file) {
  return std::filesystem::path(file).stem().string();
}

std::optional<Protocol> known_protocol(const std::string& source) {
  return twin::is_twin_spec(source) ? std::nullopt : protocol_of(source);
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

// Reads all of it; returns the pictures to be timed. Nothing after Ctrl-C.
std::optional<std::vector<KeptPicture>> read_and_describe(
    OpenRecording& recording, const std::vector<NamedDescriber>& describers,
    const SeeFrame& also_see, DescribedRecording& described) {
  const int num_timed = std::min(recording.num_frames, kMaxTimed);
  const auto source = input::prefetched(std::move(recording.source));
  core::Progress progress(recording.name + ": frames described", recording.num_frames);
  std::vector<KeptPicture> kept;
  int num_done = 0;
  while (const std::optional<core::Frame> frame = source->next()) {
    if (core::is_interrupted()) return std::nullopt;
    const cv::Mat& picture = frame->images.front();
    core::WorkerThread others([&] {
      if (also_see) also_see(*frame);
    });
    for (std::size_t i = 0; i < describers.size(); ++i) {
      described.by_describer[i].views.push_back(
          describers[i].describer->describe(frame->id, picture));
    }
    others.join();
    if (num_spread_on(num_done, recording.num_frames, num_timed) > 0)
      kept.push_back({frame->id, picture.clone()});
    progress.update(++num_done);
  }
  return kept;
}

}  // namespace

NamedDescriber make_named_describer(const std::string& word, const pipeline::Config& given) {
  describe::Config config = given.describe;
  if (word == kPaperMethod) return {word, describe::make_describer(config)};
  const auto* const method =
      std::find(describe::kMethodNames.begin(), describe::kMethodNames.end(), word);
  const bool is_file = method == describe::kMethodNames.end() || word == kNetworkWord;
  config.method = is_file ? describe::Method::kAutoencoder
                          : static_cast<describe::Method>(method - describe::kMethodNames.begin());
  if (is_file) config.network = word;
  return {is_file ? network_name(word) : word, describe::make_describer(config)};
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
  const auto protocol = known_protocol(config.source);
  if (!is_window) return protocol ? with_protocol(std::move(config), *protocol) : config;
  if (is_in_seconds) core::set_config(config, "retrieve.window_frames=-1");
  const char* key = is_in_seconds ? "retrieve.window_s=" : "retrieve.window_frames=";
  core::set_config(config, key + window);
  if (protocol && config.input.truth_tolerance_frames < 0)
    config.input.truth_tolerance_frames = protocol->tolerance_frames;
  return config;
}

std::string recording_name(const pipeline::Config& config) {
  if (config.source.starts_with(kTwin)) return config.source.substr(kTwin.size());
  return (std::filesystem::path(config.source) / "").parent_path().filename().string();
}

std::string file_stem(const pipeline::Config& config) {
  const int frames = config.retrieve.window_frames;
  std::string stem =
      frames >= 0 ? fmt::format("{}-{}", recording_name(config), frames)
                  : fmt::format("{}-{:g}s", recording_name(config), config.retrieve.window_s);
  for (char& c : stem) {
    const bool is_plain =
        std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
    if (!is_plain) c = '-';
  }
  return stem;
}

OpenRecording open_recording(const pipeline::Config& config) {
  auto source = run::open_source_with_truth(config);
  const core::SourceInfo info = source->info();
  core::Truth truth = truth_with_places(*source, config);
  return {.config = run::with_window_in_frames(config, info),
          .name = recording_name(config),
          .num_frames = info.num_frames,
          .source = std::move(source),
          .truth = std::move(truth)};
}

std::optional<DescribedRecording> describe_recording(OpenRecording recording,
                                                     const std::vector<NamedDescriber>& describers,
                                                     const SeeFrame& also_see) {
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
