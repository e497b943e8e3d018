#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "commands.hpp"
#include "options.hpp"
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/input/open.hpp>
#include <samewhere/run/bag_export.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/twin/front/twin.hpp>

namespace samewhere::app {
namespace {

struct ConvertCommand {
  std::string source;
  std::string file;
  std::string storage;
  std::string compression = "none";
  bool is_jpeg = false;
  bool is_quiet = false;
  ConfigOptions config;
};

run::BagOptions options_of(const ConvertCommand& command) {
  static const std::map<std::string, bags::Compression> compressions = {
      {"none", bags::Compression::kNone},
      {"lz4", bags::Compression::kLz4},
      {"zstd", bags::Compression::kZstd},
      {"bz2", bags::Compression::kBz2}};
  run::BagOptions options{.format = run::bag_format_of(command.file),
                          .compression = compressions.at(command.compression),
                          .is_jpeg = command.is_jpeg};
  if (command.storage == "sqlite3") options.format = bags::BagFormat::kSqlite;
  return options;
}

// As they were taken: a pair is not rectified, nothing is enlarged.
std::unique_ptr<core::Source> open_as_taken(const pipeline::Config& config) {
  return twin::is_twin_spec(config.source) ? twin::open_twin(config.source, config.twin)
                                           : input::open_source(config.source, config.input);
}

void execute(const ConvertCommand& command) {
  core::catch_interrupts();
  const run::BagOptions options = options_of(command);
  pipeline::Config config = load(command.config);
  config.source = run::absolute_source(command.source);
  config.input.needs_calibration = false;
  const auto source = open_as_taken(config);
  const int num_frames = run::write_bag(*source, command.file, options, command.is_quiet);
  core::print("{}: {} frames of {}\n", command.file, num_frames, command.source);
}

}  // namespace

void add_convert_command(CLI::App& app) {
  auto command = std::make_shared<ConvertCommand>();
  CLI::App* sub = app.add_subcommand(
      "convert", "Write a recording as a bag of messages: MCAP, rosbag2 or ROS 1");
  sub->add_option("SOURCE", command->source, "what `samewhere run` reads")->required();
  sub->add_option("FILE", command->file,
                  "FILE.mcap, FILE.db3, FILE.bag, or a new folder of rosbag2; must not exist")
      ->required();
  sub->add_option("--storage", command->storage, "of a folder: mcap (default) or sqlite3")
      ->check(CLI::IsMember({"mcap", "sqlite3"}));
  sub->add_option("--compression", command->compression,
                  "of chunks: none, lz4, zstd (MCAP), bz2 (ROS 1)")
      ->check(CLI::IsMember({"none", "lz4", "zstd", "bz2"}))
      ->capture_default_str();
  sub->add_flag("--jpeg", command->is_jpeg, "pictures as JPEG: smaller, and not the same pixels");
  sub->add_flag("--quiet", command->is_quiet, "no progress line");
  add_config_options(*sub, command->config);
  sub->callback([command] { execute(*command); });
  sub->footer(
      "Examples:\n"
      "  samewhere convert ~/data/fr1_room room.mcap --compression zstd  for Foxglove, ros2 bag\n"
      "  samewhere convert twin:hotel?seed=3 hotel.bag                   for ROS 1\n"
      "  samewhere convert walk.mp4 walk --storage sqlite3               a folder of rosbag2");
}

}  // namespace samewhere::app
