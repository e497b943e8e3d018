#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/profiles.hpp>

namespace samewhere::pipeline {
namespace {

struct RenamedKey {
  std::string_view old_path;
  std::string_view path;  // empty: removed
};

constexpr RenamedKey kRenamedKeys[] = {
    {"map.forget_after_keyframes", "map.cull_unmatched_after_keyframes"},
    {"retrieve.lost_candidates", "retrieve.relocalization_candidates"},
    {"retrieve.lost_place_frames", "retrieve.relocalization_place_frames"},
    {"retrieve.views_of_place", "retrieve.views_per_place"},
    {"track.lost", "track.relocalization"},
    {"track.min_share_by_depth", "track.depth_alignment.min_agreement"},
    {"track.start", "track.initialization"},
    {"track.initialization.max_rival_ratio", "track.initialization.max_competing_ratio"},
    {"track.relocalization.frames_to_restart", "track.relocalization.reinitialize_after_frames"},
    {"track.relocalization.max_rival_ratio", "track.relocalization.max_competing_ratio"},
    {"track.relocalization.views_to_resume", "track.relocalization.min_views"},
    {"verify.look_around_frames", "verify.neighbour_frames"},
    {"verify.max_disagreement_m", "verify.max_pose_difference_m"},
    {"verify.max_disagreement_rad", "verify.max_pose_difference_rad"},
    {"verify.max_other_place_ratio", "verify.max_competing_place_ratio"},
    {"verify.max_rival_chi_square", "verify.max_competing_chi_square"},
    {"verify.min_rival_gain", "verify.min_competing_gain"},
    {"verify.wait_views", "verify.max_pending_views"},
};

struct BuiltInProfile {
  std::string_view name;
  const char* yaml;
};

constexpr BuiltInProfile kBuiltInProfiles[] = {
    {"recognition", kRecognitionProfile},
    {"paper", kPaperProfile},
    {"usual", kUsualProfile},
};

}  // namespace

void visit_renamed_keys(core::FieldVisitor& visit) {
  for (const RenamedKey& key : kRenamedKeys) visit.renamed(key.old_path, key.path);
}

features::Config features_of_lost(const Config& config, bool is_without_depth) {
  features::Config features = config.features;
  if (is_without_depth) features.max_ratio = config.track.relocalization.max_ratio_without_depth;
  return features;
}

std::vector<std::string> profile_names() {
  std::vector<std::string> names = {"default"};
  for (const BuiltInProfile& built_in : kBuiltInProfiles) names.emplace_back(built_in.name);
  return names;
}

Config profile(const std::string& name) {
  Config config;
  if (name == "default") return config;
  for (const BuiltInProfile& built_in : kBuiltInProfiles) {
    if (name != built_in.name) continue;
    core::read_config(config, built_in.yaml, fmt::format("configs/{}.yaml", built_in.name));
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
