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

// From now on an empty value, which is what an unset variable of a shell leaves, is an error of
// every option and positional argument of the command and those below it.
void refuse_empty_values(CLI::App& command);

// After parsing has failed: the word that stands where one of the commands below `app`, or below
// the one that was chosen, is expected; with the command that was probably meant. Nothing if that
// is not what is wrong.
std::optional<std::string> unknown_command(const CLI::App& app);

}  // namespace samewhere::app
