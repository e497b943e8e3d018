#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/pipeline/session.hpp>

namespace samewhere::pipeline {

SessionState SessionState::in_known_map(const track::Config& config, std::uint64_t num_keyframes) {
  SessionState state(config, DepthFrom::kSensor);
  state.is_map_known_ = true;
  state.state_ = Lost{};
  state.tracked_since_keyframe_ = num_keyframes;
  return state;
}

SessionPhase SessionState::phase() const {
  using enum SessionPhase;
  if (std::holds_alternative<NoMap>(state_)) return kInitializing;
  const TrackedFrame* last = last_frame();
  if (last == nullptr) return std::get<Lost>(state_).is_provisional ? kProvisional : kLost;
  switch (last->tracked.pose.status) {
    case core::FrameStatus::kWeak:
      return kWeak;
    case core::FrameStatus::kResumed:
      return kRelocalized;
    default:
      return kTracking;
  }
}

void SessionState::initialize(TrackedFrame first) {
  core::require(last_frame() == nullptr, "a map that is tracked is not discarded");
  core::require(!is_map_known_, "a known map is not discarded");
  if (is_lost()) ++num_reinitializations_;
  initialized_at_s_ = first.tracked.view.stamp_s;
  state_ = std::move(first);
}

void SessionState::track(TrackedFrame frame) {
  core::require(!is_initializing(), "a frame is tracked in a map");
  core::require(is_lost() == (frame.tracked.pose.status == core::FrameStatus::kResumed),
                "after a loss the camera is relocalized, and only then");
  num_lost_frames_ = 0;
  state_ = std::move(frame);
}

void SessionState::lose(std::uint64_t num_keyframes) {
  core::require(!is_initializing(), "a camera is lost in a map");
  ++num_lost_frames_;
  tracked_since_keyframe_ = num_keyframes;
  state_ = Lost{};
}

void SessionState::hold(std::uint64_t num_keyframes) {
  core::require(is_lost(), "a relocalization is provisional after a loss");
  lose(num_keyframes);
  state_ = Lost{.is_provisional = true};
}

bool SessionState::may_reinitialize(double stamp_s, const MapAge& map) const {
  if (phase() != SessionPhase::kLost || is_map_known_ || !is_map_provisional(stamp_s, map))
    return false;
  return depth_from_ == DepthFrom::kMotion ||
         num_lost_frames_ >= config_.relocalization.reinitialize_after_frames;
}

bool SessionState::is_map_provisional(double stamp_s, const MapAge& map) const {
  const bool is_small =
      map.num_keyframes < static_cast<std::uint64_t>(config_.initialization.provisional_keyframes);
  if (is_small || depth_from_ == DepthFrom::kMotion || !map.last_pose_at_s) return is_small;
  const double tracked_s = *map.last_pose_at_s - initialized_at_s_;
  return tracked_s < config_.initialization.provisional_s &&
         stamp_s - *map.last_pose_at_s > tracked_s;
}

}  // namespace samewhere::pipeline
