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
  const bool is_one_enough =
      config.verify.prior == verify::Prior::kUnique && is_shortly_after(last_pose, stamp_s);
  return is_one_enough ? 1 : config.track.relocalization.min_views;
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
    : config_(config),
      hypotheses_(config, lost_tracker(config, depth_from)),
      provisional_(config, lost_tracker(config, depth_from)) {}

void Relocalization::reset() {
  hypotheses_.reset();
  provisional_.reset();
}

Relocalization::Result Relocalization::evaluate(const features::View& view,
                                                const scene::MapVersion& map,
                                                const std::vector<Place>* candidates,
                                                const LastMotion& motion) {
  if (is_provisional()) return follow(view, map, candidates);
  return begin(view, map, candidates == nullptr ? std::vector<Place>() : *candidates, motion);
}

Relocalization::Result Relocalization::begin(const features::View& view,
                                             const scene::MapVersion& map,
                                             const std::vector<Place>& candidates,
                                             const LastMotion& motion) {
  const core::FramePose* last = motion.last;
  // without depth every pose is reachable, also a weak one in a look-alike place
  const bool may_be_weak = is_shortly_after(last, view.stamp_s) && !is_without_depth(map);
  RequiredEvidence required{num_views_required(config_, last, view.stamp_s), may_be_weak, {}};
  const MotionPrediction prediction(map, motion, view.stamp_s, config_.verify);
  const double min_ratio = config_.track.relocalization.min_log_ratio;
  if (config_.verify.prior == verify::Prior::kRepetitive) {
    required.num_views = 1;
    required.is_predicted = [&](const core::FramePose& pose) {
      return prediction.allows(map, pose) &&
             prediction.log_likelihood_ratio(map, pose) >= min_ratio;
    };
  }
  Result result;
  result.confirmed =
      hypotheses_.evaluate(view, map, candidates, required, [&](const core::FramePose& pose) {
        return is_reachable(map, pose, last, config_.track.relocalization.max_speed_m_s);
      });
  if (result.confirmed || config_.verify.prior == verify::Prior::kUnique) {
    counts_.num_by_motion +=
        result.confirmed && config_.verify.prior != verify::Prior::kUnique ? 1 : 0;
    return result;
  }
  auto leading = hypotheses_.take_leading(config_.track.relocalization.min_views);
  if (!leading) return result;
  ++counts_.num_provisional;
  core::FramePose pose = leading->best.track.pose;
  const double by_motion = prediction.log_likelihood_ratio(map, pose);
  provisional_.begin(std::move(*leading), by_motion, view);
  pose.status = core::FrameStatus::kProvisional;
  result.provisional = pose;
  return result;
}

Relocalization::Result Relocalization::follow(const features::View& view,
                                              const scene::MapVersion& map,
                                              const std::vector<Place>* candidates) {
  using enum ProvisionalRelocalization::Decision;
  ProvisionalRelocalization::Result next = provisional_.evaluate(view, map, candidates);
  Result result;
  if (next.decision == kTakenBack) {
    ++counts_.num_taken_back;
    result.is_taken_back = true;
    return result;
  }
  result.new_from_old = next.new_from_old;
  result.reference = next.pose.reference_keyframe;
  if (next.decision == kConfirmed) {
    ++counts_.num_confirmed;
    result.confirmed = std::move(next.confirmed);
    return result;
  }
  result.provisional = next.pose;
  return result;
}

bool Relocalization::is_undecided(double stamp_s, const core::FramePose* last_pose) const {
  return is_provisional() ||
         hypotheses_.has_recent(num_views_required(config_, last_pose, stamp_s));
}

}  // namespace samewhere::pipeline
