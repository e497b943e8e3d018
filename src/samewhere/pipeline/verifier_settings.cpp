#include <samewhere/pipeline/verifier_settings.hpp>

namespace samewhere::pipeline {

verify::VerifierSettings loop_settings(const Config& config) {
  verify::VerifierSettings settings = recognition_settings(config);
  settings.measure.verify.min_views = 1;
  return settings;
}

verify::VerifierSettings relocalization_settings(const Config& config) {
  verify::VerifierSettings settings = loop_settings(config);
  settings.measure.features = features_of_lost(config, false);
  settings.features_without_depth = features_of_lost(config, true);
  settings.measure.verify.measure_all = false;  // no place is proposed from a rejected candidate
  settings.measure.verify.require_pose = false;
  return settings;
}

verify::VerifierSettings recognition_settings(const Config& config) {
  return {.measure = {config.verify, config.features, config.optimize,
                      static_cast<std::uint64_t>(config.seed)}};
}

}  // namespace samewhere::pipeline
