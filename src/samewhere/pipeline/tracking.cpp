#include <algorithm>
#include <utility>

#include <samewhere/features/orb.hpp>
#include <samewhere/map/mapper.hpp>
#include <samewhere/pipeline/tracking.hpp>
#include <samewhere/track/depth_alignment.hpp>

namespace samewhere::pipeline {
namespace {

// A program that is killed loses no more poses.
constexpr std::size_t kMaxUnsentFrames = 60;

bool is_weak(const scene::TrackedView& tracked) {
  return tracked.pose.status == core::FrameStatus::kWeak;
}

bool is_provisional(const scene::TrackedView& tracked) {
  return tracked.pose.status == core::FrameStatus::kProvisional;
}

bool is_missing_or_weak(const std::optional<scene::TrackedView>& tracked) {
  return !tracked || is_weak(*tracked);
}

bool is_loop_withdrawn(const scene::MapVersion& before, const scene::MapVersion& after) {
  return std::any_of(before.loops.begin(), before.loops.end(), [&](const scene::LoopEdge& loop) {
    return std::none_of(after.loops.begin(), after.loops.end(),
                        [&](const scene::LoopEdge& o) { return o.cause == loop.cause; });
  });
}

std::uint16_t next_session(const scene::StoredMap& known) {
  std::uint16_t last = 0;
  for (const auto& frame : known.extras.frames) last = std::max(last, frame.frame.session());
  // a session that was killed at its first keyframe has no frame yet
  for (std::size_t i = 0; i < known.map.keyframes.size(); ++i)
    last = std::max(last, known.map.keyframes[i].view.frame.session());
  for (const auto& descriptor : known.extras.descriptors)
    last = std::max(last, descriptor.frame.session());
  return static_cast<std::uint16_t>(last + 1);
}

// The frame is its keyframe.
core::FramePose initial_pose(const features::View& view, core::KeyframeId keyframe,
                             int num_landmarks) {
  return {.frame = view.frame,
          .stamp_s = view.stamp_s,
          .status = core::FrameStatus::kStarting,
          .is_measured = true,
          .reference_keyframe = keyframe,
          .num_inliers = num_landmarks};
}

}  // namespace

Tracking::Tracking(const Config& config, DepthFrom depth_from, MappingLink& mapping)
    : Tracking(config, SessionState(config.track, depth_from), {}, 0, mapping) {}

Tracking::Tracking(const Config& config, const scene::StoredMap& known, bool is_map_fixed,
                   MappingLink& mapping)
    : Tracking(config, SessionState::in_known_map(config.track, known.map.keyframes.size()),
               known.map, next_session(known), mapping) {
  is_map_known_ = true;
  is_map_fixed_ = is_map_fixed;
}

Tracking::Tracking(const Config& config, SessionState state, scene::MapVersion map,
                   std::uint16_t session, MappingLink& mapping)
    : config_(config),
      tracker_({config.track, config.features, config.optimize,
                static_cast<std::uint64_t>(config.seed)}),
      state_(std::move(state)),
      initialization_(config, state_.depth_from()),
      relocalization_(config, state_.depth_from()),
      map_(config.map, std::move(map)),
      mapping_(mapping, config.map.visible_after_frames, map_.version().keyframes.size()),
      log_(session),
      passing_(config.track.free_space),
      scale_drift_detector_(config.track.max_scale_change) {}

void Tracking::follow(std::shared_ptr<const OdometryPath> odometry) {
  core::require(log_.size() == 0, "odometry comes before the first frame");
  odometry_.emplace(config_, std::move(odometry));
}

void Tracking::feed(const core::Frame& frame) {
  core::require(frame.id == log_.next_id(), "frames are numbered from 0, in the session that runs");
  MaybeTracked tracked;
  {
    const core::ScopedTimer timer(timings_, "track");
    mapping_.forget_rows();
    exchange_with_mapping();
    const features::View view = extract(frame);
    tracked = localize(frame, view);
    record(frame, view, tracked);
  }
  insert_keyframe(frame, tracked);
}

void Tracking::finish() {
  mapping_.forget_rows();
  if (mapping_.is_keyframe_in_progress()) receive_map();
  mapping_.finish(log_.take_unsent());
}

core::Timings Tracking::timings() const {
  core::Timings timings = timings_;
  timings.add(mapping_.timings());
  return timings;
}

void Tracking::exchange_with_mapping() {
  if (mapping_.is_due(log_.size())) receive_map();
}

features::View Tracking::extract(const core::Frame& frame) {
  const core::ScopedTimer timer(timings_, "features");
  return features::extract(frame, config_.features);
}

Tracking::MaybeTracked Tracking::localize(const core::Frame& frame, const features::View& view) {
  if (is_led_by_odometry()) return follow_odometry(frame, view);
  if (state_.is_initializing()) return initialize(frame, view);
  MaybeTracked tracked = state_.is_lost() ? relocalize(frame, view) : track_in_map(frame, view);
  if (tracked && !state_.is_lost() && !is_plausible(*tracked)) tracked.reset();
  if (!tracked && may_reinitialize(view)) {
    if (MaybeTracked first = initialize(frame, view)) return first;
  }
  if (!tracked) {
    state_.lose(mapping_.num_keyframes());
    return std::nullopt;
  }
  initialization_.reset();
  if (is_provisional(*tracked)) {
    state_.hold(mapping_.num_keyframes());
    return tracked;
  }
  switch_reference(*tracked);
  check_scale(*tracked);
  update_motion_model(frame, *tracked);
  return tracked;
}

void Tracking::record(const core::Frame& frame, const features::View& view,
                      const MaybeTracked& tracked) {
  newest_ = {.features = view.features};
  if (!tracked) {
    const core::FrameStatus status = state_.is_initializing() && !is_led_by_odometry()
                                         ? initialization_.waiting_status(view)
                                         : core::FrameStatus::kLost;
    log_.add({.frame = view.frame, .stamp_s = view.stamp_s, .status = status});
    return;
  }
  newest_.pose = tracked->pose;
  newest_.last_from_newest = motion_to(tracked->pose);
  for (const auto& [feature, landmark] : tracked->landmarks)
    newest_.tracked_features.push_back(feature);
  log_.add(map_.by_odometry(tracked->pose, state_.tracked_since_keyframe()));
  if (!is_map_fixed_ && !is_provisional(*tracked)) passing_.see(frame, log_.newest());
}

std::optional<core::Rigid3> Tracking::motion_to(const core::FramePose& newest) const {
  if (log_.size() == 0 || !log_.newest().is_measured) return std::nullopt;
  if (is_reference_visible(&log_.newest()))
    return inverse(map_.world_from(log_.newest())) * map_.world_from(newest);
  // the frame before is the keyframe in progress; this one was tracked from there
  return state_.last_frame()->last_from_next;
}

void Tracking::insert_keyframe(const core::Frame& frame, const MaybeTracked& tracked) {
  if (!tracked || is_provisional(*tracked) || is_map_fixed_) return;
  if (!mapping_.may_insert() || mapping_.is_keyframe(frame.id)) return;
  if (is_worth_keeping(*tracked)) {
    send_keyframe(*tracked, frame.images[0]);
  } else if (log_.num_unsent() >= kMaxUnsentFrames) {
    mapping_.save(log_.take_unsent());
  }
}

Tracking::MaybeTracked Tracking::initialize(const core::Frame& frame, const features::View& view) {
  std::optional<InitialViews> initial = initialization_.try_view(view, frame.images[0]);
  if (!initial) return std::nullopt;
  const scene::TrackedView tracked = begin_map(frame, view, *initial);
  if (initialization_.is_monocular()) pose_earlier_frames(*initial);
  return tracked;
}

scene::TrackedView Tracking::begin_map(const core::Frame& frame, const features::View& view,
                                       InitialViews& initial) {
  discard_poses();
  if (mapping_.is_keyframe_in_progress()) receive_map();
  map_.set_version(mapping_.initialize(std::move(initial.message)));
  const core::KeyframeId newest = map_.version().keyframes.back().id;
  mapping_.note_keyframe(view.frame);
  map_.set_reference(newest);
  scene::TrackedView tracked{view, initial_pose(view, newest, initial.num_landmarks), {}, {}};
  state_.initialize({tracked, frame.depth_m, {}});
  return tracked;
}

Tracking::MaybeTracked Tracking::follow_odometry(const core::Frame& frame,
                                                 const features::View& view) {
  if (state_.is_initializing()) {
    if (!odometry_->has_pose(view.stamp_s)) return std::nullopt;
    const int num_landmarks = map::num_with_depth(view);
    // the first keyframe says whether the camera measures depth
    if (!initialization_.is_monocular() && num_landmarks == 0) return std::nullopt;
    InitialViews initial{StartMap{view, frame.images[0]}, num_landmarks, {}};
    return begin_map(frame, view, initial);
  }
  if (const core::FramePose* last = log_.last_confirmed())
    odometry_->note_images(last->stamp_s, view.stamp_s);
  const core::Rigid3 guessed =
      map_.reference_from(state_.last_frame()->tracked.pose) * predicted_motion(view);
  MaybeTracked tracked = odometry_->track(view, map_, guessed, tracker_);
  if (tracked) update_motion_model(frame, *tracked);
  return tracked;
}

// All frames are sent again.
void Tracking::discard_poses() {
  log_.discard_poses();
  passing_.forget();
  relocalization_.reset();
  scale_drift_detector_.reset();
  scale_drift_.clear();
}

void Tracking::pose_earlier_frames(const InitialViews& initial) {
  const auto& keyframes = map_.version().keyframes;
  const scene::Keyframe& first = keyframes[keyframes.size() - 2];
  mapping_.note_keyframe(first.view.frame);
  log_.at(first.view.frame) = initial_pose(first.view, first.id, initial.num_landmarks);
  core::Rigid3 reference_from_body = inverse(keyframes.back().world_from_body);
  for (const auto& view : initial.skipped) {
    const auto track = tracker_.track(view, map_.local_map(), reference_from_body);
    if (!track) continue;
    reference_from_body = track->pose.reference_from_frame;
    core::FramePose& pose = log_.at(view.frame);
    pose = track->pose;
    pose.status = core::FrameStatus::kStarting;
  }
}

Tracking::MaybeTracked Tracking::track_in_map(const core::Frame& frame,
                                              const features::View& view) {
  MaybeTracked best = track_from_last(view);
  if (is_missing_or_weak(best) && mapping_.is_keyframe_in_progress() && mapping_.may_receive()) {
    receive_map();
    track_again(view, best);
  }
  if (is_missing_or_weak(best) && can_insert_last()) {
    // the reference is too far away; what the last frame shows is nearer
    send_keyframe(state_.last_frame()->tracked, {});
    if (mapping_.may_receive()) {
      receive_map();
      track_again(view, best);
    }
  }
  if (best && best->pose.num_inliers >= config_.track.sure_inliers) return best;
  MaybeTracked by_depth = track_by_depth(frame, view);
  const bool is_better =
      by_depth && (is_missing_or_weak(best) ||
                   track::are_apart(map_.world_from(best->pose), map_.world_from(by_depth->pose)));
  return is_better ? by_depth : best;
}

core::Rigid3 Tracking::predicted_motion(const features::View& view) const {
  const TrackedFrame& last = *state_.last_frame();
  const auto measured =
      odometry_ ? odometry_->motion(last.tracked.view.stamp_s, view.stamp_s) : std::nullopt;
  return measured.value_or(last.last_from_next);
}

Tracking::MaybeTracked Tracking::track_from_last(const features::View& view) const {
  if (!map_.has_local_map()) return std::nullopt;
  const TrackedFrame& last = *state_.last_frame();
  const core::Rigid3 predicted = map_.reference_from(last.tracked.pose) * predicted_motion(view);
  const auto track = tracker_.track(view, map_.local_map(), predicted);
  if (!track) return std::nullopt;
  return map_.tracked_view(view, *track);
}

void Tracking::track_again(const features::View& view, MaybeTracked& best) const {
  MaybeTracked again = track_from_last(view);
  if (again && (!best || again->pose.num_inliers > best->pose.num_inliers)) best = std::move(again);
}

Tracking::MaybeTracked Tracking::track_by_depth(const core::Frame& frame,
                                                const features::View& view) {
  constexpr double kAll = 1.0;
  const TrackedFrame& last = *state_.last_frame();
  const bool is_enabled = config_.track.depth_alignment.min_agreement <= kAll;
  if (!is_enabled || !frame.depth_m || !last.depth_m || !map_.has_local_map()) return std::nullopt;
  const core::ScopedTimer timer(timings_, "depth alignment");
  const core::Camera& camera = view.rig->cameras[0];
  const core::Rigid3& body_from_camera = view.rig->body_from_camera[0];
  const core::Rigid3 camera_from_body = inverse(body_from_camera);
  const track::DepthAlignmentConfig& config = config_.track.depth_alignment;
  const auto aligned =
      track::align({*last.depth_m, camera, config.max_step_ratio},
                   {*frame.depth_m, camera, config.max_step_ratio},
                   camera_from_body * predicted_motion(view) * body_from_camera, config);
  if (!aligned) return std::nullopt;
  const core::Rigid3 last_from_this =
      body_from_camera * aligned->earlier_from_later * camera_from_body;
  return map_.tracked_view(
      view, tracker_.track_at(view, map_.local_map(),
                              map_.reference_from(last.tracked.pose) * last_from_this, *aligned));
}

void Tracking::switch_reference(scene::TrackedView& tracked) {
  std::vector<core::LandmarkId> seen;
  for (const auto& [feature, landmark] : tracked.landmarks) seen.push_back(landmark);
  const auto most = keyframe_showing_most(map_.version(), seen);
  if (!most) return;
  if (*most != map_.reference()) map_.set_reference(*most);
  core::FramePose& pose = tracked.pose;
  if (*most != pose.reference_keyframe) pose = map_.relative_to(*most, pose);
}

void Tracking::check_scale(scene::TrackedView& tracked) {
  const TrackedFrame* last = state_.last_frame();
  if (last == nullptr || !has_scale_drift(map_.version())) return;
  core::FramePose& pose = tracked.pose;
  const double step =
      (map_.world_from(pose).translation - map_.world_from(last->tracked.pose).translation).norm();
  const auto factor = scale_drift_detector_.update(
      pose.stamp_s, step, map::median_landmark_depth(map_.version(), tracked));
  if (!factor) return;
  if (pose.status == core::FrameStatus::kTracking) {
    pose.status = core::FrameStatus::kWeak;
    pose.information /= config_.track.drift.weak_factor * config_.track.drift.weak_factor;
  }
  track::add_to_intervals(scale_drift_, pose.frame, *factor);
}

void Tracking::update_motion_model(const core::Frame& frame, const scene::TrackedView& tracked) {
  const TrackedFrame* last = state_.last_frame();
  const core::Rigid3 last_from_this =
      last == nullptr
          ? core::Rigid3{}
          : inverse(map_.world_from(last->tracked.pose)) * map_.world_from(tracked.pose);
  state_.track({tracked, frame.depth_m, last_from_this});
}

bool Tracking::is_worth_keeping(const scene::TrackedView& tracked) const {
  return is_led_by_odometry() ? odometry_->is_worth_keeping(map_.version(), tracked)
                              : map::is_worth_keeping(map_.version(), tracked, config_.map);
}

bool Tracking::can_insert_last() const {
  const scene::TrackedView& last = state_.last_frame()->tracked;
  return !is_map_fixed_ && mapping_.may_insert() && !mapping_.is_keyframe(last.view.frame) &&
         map::can_keep(map_.version(), last.view, config_.map);
}

void Tracking::send_keyframe(const scene::TrackedView& tracked, const cv::Mat& image) {
  core::FramePose& pose = log_.newest();
  core::require(pose.frame == tracked.view.frame, "only the newest frame becomes a keyframe");
  // from now on the frame moves with its keyframe
  pose.reference_keyframe = mapping_.next_keyframe();
  pose.reference_from_frame = core::Rigid3{};
  scene::TrackedView sent = tracked;
  sent.passing = passing_.shown_in(tracked.view, tracked.pose, map_.version());
  sent.pose = map_.by_odometry(tracked.pose, state_.tracked_since_keyframe());
  mapping_.insert(std::move(sent), image, log_.take_unsent());
}

void Tracking::receive_map() {
  auto [keyframe, map] = mapping_.receive();
  const scene::MapVersion& before = map_.version();
  if (map.loops.size() != before.loops.size()) scale_drift_detector_.reset();
  TrackedFrame* last = state_.last_frame();
  // the reference may be at the other end of a loop that is gone
  if (last != nullptr && is_loop_withdrawn(before, map))
    last->tracked.pose = map_.by_odometry(last->tracked.pose, state_.tracked_since_keyframe());
  map_.set_version(std::move(map));
  map_.set_reference(keyframe);
  if (last != nullptr && last->tracked.view.frame == map_.version().at(keyframe).view.frame) {
    last->tracked.pose.reference_keyframe = keyframe;
    last->tracked.pose.reference_from_frame = core::Rigid3{};
  }
}

}  // namespace samewhere::pipeline
