// Tracking where the camera is lost or may be in a look-alike place.
#include <algorithm>
#include <utility>

#include <samewhere/pipeline/tracking.hpp>

namespace samewhere::pipeline {

bool Tracking::may_reinitialize(const features::View& view) const {
  const core::FramePose* last = log_.last_confirmed();
  const SessionState::MapAge age{mapping_.num_keyframes_of_map(),
                                 last == nullptr ? std::nullopt : std::optional(last->stamp_s)};
  return !is_map_fixed_ && state_.may_reinitialize(view.stamp_s, age) &&
         !relocalization_.is_undecided(view.stamp_s, last);
}

bool Tracking::is_reference_visible(const core::FramePose* frame) const {
  return frame == nullptr || frame->reference_keyframe.index() < map_.version().keyframes.size();
}

bool Tracking::is_plausible(const scene::TrackedView& tracked) {
  constexpr double kGap_s = 1.0;
  const core::FramePose* last = log_.last_confirmed();
  if (config_.verify.prior == verify::Prior::kUnique || last == nullptr) return true;
  const core::FramePose* before = log_.before(*last);
  const double usual_s = before == nullptr ? 0.0 : last->stamp_s - before->stamp_s;
  if (tracked.pose.stamp_s - last->stamp_s <= std::max(kGap_s, 2.0 * usual_s)) return true;
  if (!is_reference_visible(last) || !is_reference_visible(before)) receive_map();
  const scene::MapVersion& map = map_.version();
  const MotionPrediction prediction(map, {last, before}, tracked.pose.stamp_s, config_.verify);
  // a look-alike place is tracked as well: as for a lost camera, motion must tell them apart
  return prediction.log_likelihood_ratio(map, tracked.pose) >=
         config_.track.relocalization.min_log_ratio;
}

std::optional<std::vector<Place>> Tracking::places_for(const core::Frame& frame,
                                                       const features::View& view) {
  const bool is_provisional = relocalization_.is_provisional();
  const bool is_asked_before = is_provisional || !mapping_.waits_for_places();
  if (is_asked_before && !mapping_.are_places_due(log_.size())) return std::nullopt;
  MapAnswer answer =
      is_asked_before ? mapping_.receive_places() : mapping_.find_places(view, frame.images[0]);
  const bool has_changed = answer.map.number != map_.version().number;
  map_.set_version(std::move(answer.map));
  if (has_changed && map_.has_local_map())
    map_.set_reference(holder_of(map_.version(), map_.reference()).keyframe);
  // the last reference is a candidate, too
  if (map_.has_local_map() && !is_provisional)
    answer.places.push_back({map_.reference(), std::nullopt, true});
  return std::move(answer.places);
}

void Tracking::ask_for_places(const core::Frame& frame, const features::View& view) {
  if (mapping_.is_keyframe_in_progress() || mapping_.are_places_asked()) return;
  if (!relocalization_.is_provisional() && mapping_.waits_for_places()) return;
  if (relocalization_.is_provisional() && !relocalization_.wants_places()) return;
  mapping_.ask_places(view, frame.images[0]);
  relocalization_.note_asked();
}

Tracking::MaybeTracked Tracking::relocalize(const core::Frame& frame, const features::View& view) {
  const std::optional<std::vector<Place>> places = places_for(frame, view);
  if (!places && !relocalization_.is_provisional()) {
    ask_for_places(frame, view);
    return std::nullopt;
  }
  const core::FramePose* last = log_.last_confirmed();
  const LastMotion motion{last, last == nullptr ? nullptr : log_.before(*last)};
  auto result = relocalization_.evaluate(view, map_.version(), places ? &*places : nullptr, motion);
  update_provisional(result);
  ask_for_places(frame, view);
  if (result.provisional) return scene::TrackedView{view, *result.provisional, {}, {}};
  if (!result.confirmed) return std::nullopt;
  map_.set_local_map(std::move(result.confirmed->local_map));
  scene::TrackedView tracked = map_.tracked_view(view, result.confirmed->track);
  tracked.pose.status = core::FrameStatus::kResumed;
  return tracked;
}

void Tracking::update_provisional(const Relocalization::Result& result) {
  if (result.new_from_old) {
    log_.move_provisional([&](core::FramePose pose) {
      const core::Rigid3 world_from_frame = *result.new_from_old * map_.world_from(pose);
      pose.reference_keyframe = result.reference;
      pose.reference_from_frame =
          inverse(world_from_body(map_.version(), result.reference)) * world_from_frame;
      return pose;
    });
  }
  if (result.confirmed) log_.confirm_provisional(config_.track.weak_inliers);
  if (result.is_taken_back) log_.take_back_provisional();
}

}  // namespace samewhere::pipeline
