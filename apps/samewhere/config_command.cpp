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
  bool only_expert = false;
};

void print(const ConfigCommand& command) {
  const pipeline::Config config = load(command.config);
  const core::Listed listed = command.only_expert ? core::Listed::kExpert : core::Listed::kBasic;
  core::print("{}", command.as_table ? core::config_as_table(config, listed)
                                     : core::config_as_yaml(config, true, listed));
}

}  // namespace

void add_config_command(CLI::App& app) {
  auto command = std::make_shared<ConfigCommand>();
  CLI::App* sub = app.add_subcommand("config", "Print all settings with their meaning and range");
  add_config_options(*sub, command->config);
  sub->add_flag("--table", command->as_table, "as Markdown tables instead of YAML");
  sub->add_flag("--expert", command->only_expert,
                "the settings that are rarely changed, instead of the others");
  sub->footer(
      "Examples:\n"
      "  samewhere config                           the settings with their defaults\n"
      "  samewhere config --expert                  the other ones: constants of the methods\n"
      "  samewhere config --profile paper > my.yaml a file to edit and give to --config");
  sub->callback([command] { print(*command); });
}

}  // namespace samewhere::app
