#include <cstdint>

#include <samewhere/pipeline/relocalization.hpp>

namespace samewhere::pipeline {
namespace {

track::Tracker lost_tracker(const Config& config, DepthFrom depth_from) {
  return track::Tracker({config.track, features_of_lost(config, depth_from == DepthFrom::kMotion),
                         config.optimize, static_cast<std::uint64_t>(config.seed)});
}

bool is_shortly_after(const core::FramePose* last_pose, double stamp_s) {
  constexpr double kShortly_s = 1.0;
  return last_pose != nullptr && stamp_s - last_pose->stamp_s <= kShortly_s;
}

int num_views_required(const Config& config, const core::FramePose* last_pose, double stamp_s) {
  return is_shortly_after(last_pose, stamp_s) ? 1
                                              : config.track.relocalization.min_views;
}

// Farther poses belong to a look-alike place.
bool is_reachable(const scene::MapVersion& map, const core::FramePose& pose,
                  const core::FramePose* last_pose, double max_speed_m_s) {
  constexpr double kMapCorrection_m = 0.5;  // the map may have moved since
  if (last_pose == nullptr || is_without_depth(map)) return true;
  const double distance_m =
      (world_from_frame(map, pose).translation - world_from_frame(map, *last_pose).translation)
          .norm();
  return distance_m <= kMapCorrection_m + max_speed_m_s * (pose.stamp_s - last_pose->stamp_s);
}

}  // namespace

Relocalization::Relocalization(const Config& config, DepthFrom depth_from)
    : config_(config), hypotheses_(config, lost_tracker(config, depth_from)) {}

std::optional<RelocalizedPose> Relocalization::evaluate(const features::View& view,
                                                        const scene::MapVersion& map,
                                                        const std::vector<Place>& candidates,
                                                        const core::FramePose* last_pose) {
  // without depth every pose is reachable, also a weak one in a look-alike place
  const bool may_be_weak = is_shortly_after(last_pose, view.stamp_s) && !is_without_depth(map);
  const RequiredEvidence required{num_views_required(config_, last_pose, view.stamp_s),
                                  may_be_weak};
  return hypotheses_.evaluate(view, map, candidates, required, [&](const core::FramePose& pose) {
    return is_reachable(map, pose, last_pose, config_.track.relocalization.max_speed_m_s);
  });
}

bool Relocalization::is_undecided(double stamp_s, const core::FramePose* last_pose) const {
  return hypotheses_.has_recent(num_views_required(config_, last_pose, stamp_s));
}

}  // namespace samewhere::pipeline
