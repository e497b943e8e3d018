// How tracking begins a map, and gives one up that was hardly begun.
#include <utility>

#include <fmt/format.h>

#include <samewhere/pipeline/tracking.hpp>

namespace samewhere::pipeline {
namespace {

// The frame is its keyframe.
core::FramePose starting_pose(const features::View& view, core::KeyframeId keyframe,
                              int num_landmarks) {
  return {.frame = view.frame,
          .stamp_s = view.stamp_s,
          .status = core::FrameStatus::kStarting,
          .is_measured = true,
          .reference_keyframe = keyframe,
          .num_inliers = num_landmarks};
}

}  // namespace

std::optional<map::TrackedView> Tracking::start(const core::Frame& frame,
                                                const features::View& view) {
  num_features_ = view.features->size();
  if (starter_) return start_by_motion(frame, view);
  num_with_depth_ = map::num_with_depth(view);
  if (!map::can_start(view, config_.map)) return std::nullopt;
  mapping_.send(StartMap{view, frame.images[0]});
  give_up_poses();
  begin_tracking(view, map::num_with_depth(view));
  last_depth_m_ = frame.depth_m;
  return last_;
}

std::string Tracking::why_not_started() const {
  if (num_features_ < config_.map.min_landmarks) {
    return fmt::format("{} corners in the picture, expected {}: it is dark, blurred or of one tone",
                       num_features_, config_.map.min_landmarks);
  }
  if (!starter_ && num_with_depth_ == 0) {
    return fmt::format(
        "none of {} features has depth, expected {}: the depth pictures are missing or empty",
        num_features_, config_.map.min_landmarks);
  }
  if (!starter_) {
    return fmt::format("{} features with depth, expected {}", num_with_depth_,
                       config_.map.min_landmarks);
  }
  return starter_->last_refusal().empty() ? "there is no second view" : starter_->last_refusal();
}

std::optional<map::TrackedView> Tracking::start_by_motion(const core::Frame& frame,
                                                          const features::View& view) {
  auto started = starter_->offer(view);
  if (!started) return std::nullopt;
  const track::Start& start = started->start;
  mapping_.send(StartMapByMotion{{started->first, view, start.first_from_second, start.information,
                                  start.matches, start.points_in_first},
                                 frame.images[0]});
  const auto num_landmarks = static_cast<int>(start.matches.size());
  give_up_poses();
  begin_tracking(view, num_landmarks);
  const scene::Keyframe& first = map_.keyframes[map_.keyframes.size() - 2];
  keyframe_of_[first.view.frame] = first.id;
  frames_[first.view.frame.index()] = starting_pose(first.view, first.id, num_landmarks);
  locate_passed(started->between);
  return last_;
}

bool Tracking::is_start_doubtful(double stamp_s) const {
  if (session_ != 0) return false;
  const track::StartConfig& config = config_.track.start;
  const bool is_small =
      num_keyframes_ - num_given_up_ < static_cast<std::uint64_t>(config.provisional_keyframes);
  const core::FramePose* last = last_measured();
  if (is_small || starter_ || last == nullptr) return is_small;
  const double followed_s = last->stamp_s - started_at_s_;
  return followed_s < config.provisional_s && stamp_s - last->stamp_s > followed_s;
}

std::optional<map::TrackedView> Tracking::start_anew(const core::Frame& frame,
                                                     const features::View& view) {
  if (!starter_ && num_lost_ < config_.track.lost.frames_to_restart) return std::nullopt;
  if (place_finder_.has_fresh_place(proof_to_resume(view.stamp_s).num_views)) return std::nullopt;
  return start(frame, view);
}

// What was sent is sent again.
void Tracking::give_up_poses() {
  passing_.forget();
  if (num_keyframes_ > num_given_up_) ++num_starts_given_up_;
  place_finder_.forget();
  scale_watch_.forget();
  scale_doubts_.clear();
  for (auto& pose : frames_) {
    const core::FrameStatus status =
        is_waiting(pose.status) ? pose.status : core::FrameStatus::kLost;
    pose = {.frame = pose.frame, .stamp_s = pose.stamp_s, .status = status};
  }
  keyframe_of_.clear();
  num_given_up_ = num_keyframes_;
  num_sent_frames_ = 0;
}

void Tracking::locate_passed(const std::vector<features::View>& views) {
  core::Rigid3 reference_from_body = inverse(map_.keyframes.back().world_from_body);
  for (const auto& view : views) {
    const auto track = tracker_.track(view, local_map_, reference_from_body);
    if (!track) continue;
    reference_from_body = track->pose.reference_from_frame;
    core::FramePose& pose = frames_[view.frame.index()];
    pose = track->pose;
    pose.status = core::FrameStatus::kStarting;
  }
}

// The view is the newest keyframe of the map that mapping begins.
void Tracking::begin_tracking(const features::View& view, int num_landmarks) {
  map_ = wait_for_mapping().map;
  num_keyframes_ = map_.keyframes.size();
  started_at_s_ = view.stamp_s;
  const core::KeyframeId newest = map_.keyframes.back().id;
  keyframe_of_[view.frame] = newest;
  look_around(newest);
  last_ = map::TrackedView{view, starting_pose(view, newest, num_landmarks), {}, {}};
  last_from_next_ = {};
}

}  // namespace samewhere::pipeline
