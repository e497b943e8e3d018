#pragma once

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

}  // namespace samewhere::app
