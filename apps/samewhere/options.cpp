#include "options.hpp"

#include <fmt/format.h>

#include <samewhere/core/nearest_word.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/run/run_folder.hpp>

namespace samewhere::app {

void add_config_options(CLI::App& command, ConfigOptions& options) {
  command
      .add_option("--profile", options.profile,
                  "built-in settings: default, recognition (of `samewhere loops`), paper (the "
                  "published method), or usual (bag of words and geometry alone, to compare with)")
      ->capture_default_str();
  command.add_option("--config", options.file, "YAML file with settings that override the profile");
  command
      .add_option("--set", options.assignments,
                  "one setting, e.g. verify.min_inliers=30; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
}

pipeline::Config load(const ConfigOptions& options) {
  return pipeline::load_config(options.profile, options.file, options.assignments);
}

std::string as_run_folder(const std::string& path) { return run::run_folder_of(path).string(); }

std::string as_map_file(const std::string& path) { return run::map_file_of(path).string(); }

void refuse_empty_values(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    if (option->get_items_expected_max() == 0) continue;  // a flag
    option->check(
        [](const std::string& value) {
          return value.empty() ? std::string("is empty; expected a value") : std::string();
        },
        "", "not empty");
  }
  for (CLI::App* below : command.get_subcommands([](CLI::App*) { return true; }))
    refuse_empty_values(*below);
}

std::optional<std::string> unknown_command(const CLI::App& app) {
  for (const CLI::App* chosen : app.get_subcommands()) return unknown_command(*chosen);
  const std::vector<std::string> words = app.remaining();
  std::vector<std::string> names;
  for (const CLI::App* below : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(below->get_name());
  if (names.empty() || words.empty() || words.front().starts_with("-")) return std::nullopt;
  const std::string& word = words.front();
  const auto meant = core::nearest_word(word, names);
  return fmt::format("there is no command {}; {}", core::printable(word),
                     meant ? "did you mean " + *meant + "?"
                           : fmt::format("expected one of: {}", fmt::join(names, ", ")));
}

}  // namespace samewhere::app
