#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "options.hpp"
#include <samewhere/core/terminal.hpp>

namespace samewhere::app {
namespace {

struct ConfigCommand {
  ConfigOptions config;
  bool as_table = false;
};

void print(const ConfigCommand& command) {
  const pipeline::Config config = load(command.config);
  core::print(
      "{}", command.as_table ? core::config_as_table(config) : core::config_as_yaml(config, true));
}

}  // namespace

void add_config_command(CLI::App& app) {
  auto command = std::make_shared<ConfigCommand>();
  CLI::App* sub = app.add_subcommand("config", "Print all settings with their meaning and range");
  add_config_options(*sub, command->config);
  sub->add_flag("--table", command->as_table, "as Markdown tables instead of YAML");
  sub->footer(
      "Examples:\n"
      "  samewhere config                           every setting with its default\n"
      "  samewhere config --profile paper > my.yaml a file to edit and give to --config");
  sub->callback([command] { print(*command); });
}

}  // namespace samewhere::app
