#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/profiles.hpp>

namespace samewhere::pipeline {

features::Config features_of_lost(const Config& config, bool is_without_depth) {
  features::Config features = config.features;
  if (is_without_depth) features.max_ratio = config.track.lost.max_ratio_without_depth;
  return features;
}

std::vector<std::string> profile_names() { return {"default", "recognition", "paper"}; }

Config profile(const std::string& name) {
  Config config;
  if (name == "default") return config;
  if (name == "paper") {
    core::read_config(config, kPaperProfile, "configs/paper.yaml");
    return config;
  }
  if (name == "recognition") {
    core::read_config(config, kRecognitionProfile, "configs/recognition.yaml");
    return config;
  }
  throw core::InputError(fmt::format("unknown profile {}; expected one of: {}", name,
                                     fmt::join(profile_names(), ", ")));
}

Config load_config(const std::string& profile_name, const std::filesystem::path& file,
                   const std::vector<std::string>& assignments) {
  Config config = profile(profile_name);
  if (!file.empty())
    core::read_config(config, core::read_file(file, core::kSettingsLimit), file.string());
  for (const auto& assignment : assignments) core::set_config(config, assignment);
  return config;
}

}  // namespace samewhere::pipeline
