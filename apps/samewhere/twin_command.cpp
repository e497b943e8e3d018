#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "commands.hpp"
#include "options.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/pipeline/open_source.hpp>
#include <samewhere/twin/dataset.hpp>
#include <samewhere/twin/spec.hpp>

namespace samewhere::app {
namespace {

struct TwinCommand {
  std::string source;
  std::string out;
  std::string format = "tum";
  ConfigOptions config;
  bool is_list = false;
};

void print_presets() {
  std::size_t width = 0;
  for (const auto& preset : twin::list_presets()) width = std::max(width, preset.name.size());
  for (const auto& preset : twin::list_presets()) {
    fmt::print("twin:{:<{}}  {}\n", preset.name, width, preset.what);
  }
}

void check(const TwinCommand& command) {
  if (command.source.empty()) {
    throw core::InputError("twin: no building was named; expected twin:PRESET or --list");
  }
  if (command.out.empty()) {
    throw core::InputError("twin: no folder was named; expected --out DIR, a name that is free");
  }
  if (command.format != "tum" && command.format != "euroc") {
    throw core::InputError(fmt::format("--format {}: expected one of: tum, euroc", command.format));
  }
}

int write(const TwinCommand& command) {
  check(command);
  core::catch_interrupts();
  pipeline::Config config = load(command.config);
  config.source = pipeline::absolute_source(command.source);
  const auto source = pipeline::open_source(config);
  const auto written = command.format == "tum" ? twin::write_tum_folder(*source, command.out)
                                               : twin::write_euroc_folder(*source, command.out);
  if (written == twin::Written::kInterrupted) return kInterrupted;
  fmt::print("{}: {} frames of {}\n", command.out, source->info().num_frames, command.source);
  return kDone;
}

}  // namespace

void add_twin_command(CLI::App& app, int& exit_code) {
  auto command = std::make_shared<TwinCommand>();
  CLI::App* sub = app.add_subcommand(
      "twin", "Write a walk through a rendered look-alike building as a folder others can read");
  sub->add_option("SOURCE", command->source,
                  "twin:PRESET?seed=3&similarity=0.9, or any recording that `run` reads");
  sub->add_option("--out", command->out, "folder to write, a name that is free");
  sub->add_option("--format", command->format,
                  "tum (TUM RGB-D: colour, depth, poses) or euroc (EuRoC: one or two cameras, "
                  "inertial samples, poses)")
      ->capture_default_str();
  sub->add_flag("--list", command->is_list, "print the presets, a line each");
  add_config_options(*sub, command->config);
  sub->footer(
      "Examples:\n"
      "  samewhere twin --list\n"
      "  samewhere twin 'twin:hotel?seed=3&similarity=0.9' --out hotel --format tum\n"
      "  samewhere twin 'twin:mirror?camera=stereo' --out mirror --format euroc\n"
      "  samewhere twin twin:office-loop --out short --set twin.num_frames=100");
  sub->callback([command, &exit_code] {
    if (command->is_list) {
      print_presets();
    } else {
      exit_code = write(*command);
    }
  });
}

}  // namespace samewhere::app
