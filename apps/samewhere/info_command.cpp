#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "commands.hpp"
#include "options.hpp"
#include "print.hpp"
#include <samewhere/bags/survey.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/input/bag_source.hpp>
#include <samewhere/paper/protocols.hpp>
#include <samewhere/report/figure.hpp>
#include <samewhere/report/table.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/twin/front/twin.hpp>

namespace samewhere::app {
namespace {

constexpr double kPerSecond = 1e9;

std::string seconds_text(std::int64_t ns) {
  return fmt::format("{:.3f} s", static_cast<double>(ns) / kPerSecond);
}

// Between the first and the last message, with the longest gap between two.
std::vector<std::string> row_of(const bags::Topic& topic, const bags::TopicTimes& times,
                                std::int64_t start_ns) {
  const double duration_s = static_cast<double>(times.last_ns - times.first_ns) / kPerSecond;
  const bool has_rate = times.num_messages > 1 && duration_s > 0.0;
  return {topic.name,
          topic.type.empty() ? "no schema" : topic.type,
          topic.encoding,
          fmt::format("{}", times.num_messages),
          has_rate ? fmt::format("{:.2f}", static_cast<double>(times.num_messages - 1) / duration_s)
                   : "-",
          has_rate ? seconds_text(times.longest_gap_ns) : "-",
          has_rate ? seconds_text(times.gap_from_ns - start_ns) : "-"};
}

void print_bag_figures(const bags::BagInfo& info) {
  std::vector<report::Figure> figures = {
      {"format", info.format},
      {"compression", info.compression},
      report::figure("messages", "{}", info.num_messages),
      report::figure("duration", "{:.3f} s",
                     static_cast<double>(info.last_ns - info.first_ns) / kPerSecond),
      report::figure("first message", "{:.9f} s", static_cast<double>(info.first_ns) / kPerSecond)};
  if (!info.is_closed) figures.push_back({"closed", "no: its recorder was ended"});
  if (!info.damage.empty()) figures.push_back({"damage", info.damage});
  print_figures(figures);
}

void print_choice(const std::filesystem::path& file, const std::vector<bags::Topic>& topics,
                  const input::Config& config) {
  input::BagTopics chosen;
  try {
    chosen = input::topics_of_bag(file, config);
  } catch (const core::InputError& error) {
    core::print("\n`samewhere run` cannot use it: {}\n", error.what());
    return;
  }
  std::vector<report::Figure> figures;
  const auto add = [&](const char* role, int topic) {
    if (topic >= 0) figures.push_back({role, topics[static_cast<std::size_t>(topic)].name});
  };
  add("color", chosen.color);
  add("camera_info", chosen.camera_info);
  add("right", chosen.right);
  add("right_camera_info", chosen.right_camera_info);
  add("depth", chosen.depth);
  add("imu", chosen.imu);
  add("odometry", chosen.odometry);
  add("truth", chosen.truth);
  core::print("\n`samewhere run` reads, unless --topics names others:\n");
  print_figures(figures);
  if (chosen.odometry >= 0)
    core::print("odometry is used with --odometry {}\n", file.filename().string());
}

void print_bag(const std::filesystem::path& file, const input::Config& config) {
  const auto bag = bags::open_bag(file);
  print_bag_figures(bag->info());
  const std::vector<bags::TopicTimes> times = bags::survey(*bag);
  report::Table table{
      .header = {"topic", "type", "encoding", "messages", "rate, Hz", "longest gap", "gap after"},
      .rows = {}};
  for (std::size_t i = 0; i < times.size(); ++i)
    table.rows.push_back(row_of(bag->topics()[i], times[i], bag->info().first_ns));
  core::print("\n{}", report::as_text(table));
  print_choice(file, bag->topics(), config);
}

std::string window_text(const pipeline::Config& config, const core::SourceInfo& info) {
  const int window_frames = run::with_window_in_frames(config, info).retrieve.window_frames;
  if (config.retrieve.window_frames >= 0) return fmt::format("{} frames", window_frames);
  return fmt::format("{} s, {} frames", config.retrieve.window_s, window_frames);
}

std::string truth_text(const pipeline::Config& config, const core::SourceInfo& info,
                       const core::Truth& truth) {
  if (!truth.places)
    return info.has_depth && !truth.trajectory.empty() ? "by depth and poses" : "none";
  const int window_frames = run::with_window_in_frames(config, info).retrieve.window_frames;
  return fmt::format("{} of {} queries have a loop",
                     paper::num_queries_with_loop(*truth.places, window_frames),
                     truth.places->num_frames);
}

void add_truth_of_places(const pipeline::Config& config, const paper::Protocol* protocol,
                         const core::Source& source, std::vector<report::Figure>& figures) {
  const core::Truth truth = source.truth();
  if (!protocol && !truth.places) return;
  const core::SourceInfo info = source.info();
  if (protocol) figures.push_back({"data set", protocol->data_set});
  figures.push_back({"exclusion window", window_text(config, info)});
  figures.push_back(report::figure("tolerance of the truth", "{} frames",
                                   std::max(0, config.input.truth_tolerance_frames)));
  figures.push_back({"truth of places", truth_text(config, info, truth)});
  if (!protocol) return;
  const std::vector<std::string> missing = paper::missing_of(*protocol, info, truth);
  figures.push_back(
      {"missing", missing.empty() ? "nothing" : fmt::format("{}", fmt::join(missing, "; "))});
}

void print_source(const pipeline::Config& given) {
  const bool is_twin = twin::is_twin_spec(given.source);
  const auto protocol = is_twin ? std::nullopt : paper::protocol_of(given.source);
  const pipeline::Config config = protocol ? paper::with_protocol(given, *protocol) : given;
  const auto source = run::open_source(config);
  const core::SourceInfo info = source->info();
  const core::Trajectory truth = source->true_trajectory();
  std::vector<report::Figure> figures = {
      {"format", info.format},
      report::figure("frames", "{}", info.num_frames),
      report::figure("rate", "{:.2f} Hz", info.frame_rate_hz),
      report::figure("cameras", "{}", info.num_cameras),
      {"calibration", info.is_calibrated ? "yes" : "none"},
      {"depth", info.has_depth ? "yes" : "no"},
      {"true poses", truth.empty() ? "none" : fmt::format("{}", truth.size())}};
  // a rendered building would have to be looked through
  if (!is_twin) add_truth_of_places(config, protocol ? &*protocol : nullptr, *source, figures);
  print_figures(figures);
}

void execute(const std::string& source, const ConfigOptions& options) {
  core::catch_interrupts();
  pipeline::Config config = load(options);
  config.source = run::absolute_source(source);
  config.input.needs_calibration = false;
  if (!twin::is_twin_spec(config.source) && bags::is_bag(config.source)) {
    print_bag(config.source, config.input);
  } else {
    print_source(config);
  }
}

}  // namespace

void add_info_command(CLI::App& app) {
  struct InfoCommand {
    std::string source;
    ConfigOptions config;
  };
  auto command = std::make_shared<InfoCommand>();
  CLI::App* sub = app.add_subcommand(
      "info",
      "What a recording holds: topics, types, rates and gaps of a bag; frames and truth of others, "
      "and what a download of a known data set lacks");
  sub->add_option("SOURCE", command->source, "what `samewhere run` reads")->required();
  add_config_options(*sub, command->config);
  sub->callback([command] { execute(command->source, command->config); });
  sub->footer(
      "Examples:\n"
      "  samewhere info walk.mcap       a bag, and which of its topics a run reads\n"
      "  samewhere info ~/data/fr1_room a folder");
}

}  // namespace samewhere::app
