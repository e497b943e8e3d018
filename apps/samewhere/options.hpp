#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <samewhere/pipeline/config.hpp>

namespace samewhere::app {

// Options that choose the config: --profile, --config, --set.
struct ConfigOptions {
  std::string profile = "default";
  std::string file;
  std::vector<std::string> assignments;
};

void add_config_options(CLI::App& command, ConfigOptions& options);
pipeline::Config load(const ConfigOptions& options);

// For CLI::Option::transform: a run's folder or the map in it, as the folder or as the map.
std::string as_run_folder(const std::string& path);
std::string as_map_file(const std::string& path);

// Makes an empty value, such as that of an unset shell variable, an error for all options and
// positional arguments of the command and its subcommands.
void refuse_empty_values(CLI::App& command);

// After failed parsing: the word in place of a subcommand of `app` or of the chosen command, with
// the command that was probably meant. Nothing if the failure has another reason.
std::optional<std::string> unknown_command(const CLI::App& app);

}  // namespace samewhere::app
