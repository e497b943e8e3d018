#include "options.hpp"

namespace samewhere::app {

void add_config_options(CLI::App& command, ConfigOptions& options) {
  command
      .add_option("--profile", options.profile,
                  "built-in settings: default, recognition (of `samewhere loops`), or paper (the "
                  "published method)")
      ->capture_default_str();
  command.add_option("--config", options.file,
                     "YAML file with settings that differ from the profile");
  command
      .add_option("--set", options.assignments,
                  "one setting, e.g. verify.min_inliers=30; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
}

pipeline::Config load(const ConfigOptions& options) {
  return pipeline::load_config(options.profile, options.file, options.assignments);
}

}  // namespace samewhere::app
