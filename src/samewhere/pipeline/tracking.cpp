#include <algorithm>
#include <utility>

#include <samewhere/features/orb.hpp>
#include <samewhere/pipeline/tracking.hpp>
#include <samewhere/track/depth_alignment.hpp>
#include <samewhere/track/drift_model.hpp>

namespace samewhere::pipeline {
namespace {

// A program that is killed loses no more poses.
constexpr std::size_t kMaxUnsentFrames = 60;

// An hour at 30 Hz: so much address space, of which memory is taken as frames come. A vector that
// grows by copying leaves as much again behind.
constexpr std::size_t kReservedFrames = 108000;

bool is_weak(const scene::TrackedView& tracked) {
  return tracked.pose.status == core::FrameStatus::kWeak;
}

bool has_lost_a_loop(const scene::MapVersion& before, const scene::MapVersion& after) {
  return std::any_of(before.loops.begin(), before.loops.end(), [&](const scene::LoopEdge& loop) {
    return std::none_of(after.loops.begin(), after.loops.end(),
                        [&](const scene::LoopEdge& o) { return o.cause == loop.cause; });
  });
}

}  // namespace

Tracking::Tracking(const Config& config, DepthFrom depth_from, MappingLink& mapping)
    : config_(config),
      tracker_({config.track, config.features, config.optimize,
                static_cast<std::uint64_t>(config.seed)}),
      lost_tracker_({config.track, features_of_lost(config, depth_from == DepthFrom::kMotion),
                     config.optimize, static_cast<std::uint64_t>(config.seed)}),
      place_finder_(config_, lost_tracker_),
      passing_(config.track.free_space),
      scale_watch_(config.track.max_scale_change),
      mapping_(mapping) {
  frames_.reserve(kReservedFrames);
  if (depth_from == DepthFrom::kMotion) {
    starter_.emplace(track::StartSettings{config.track.initialization, config.track.drift,
                                          config.features, config.optimize,
                                          static_cast<std::uint64_t>(config.seed)});
  }
}

Tracking::Tracking(const Config& config, const scene::StoredMap& known, bool is_map_fixed,
                   MappingLink& mapping)
    : Tracking(config, DepthFrom::kSensor, mapping) {
  map_ = known.map;
  num_keyframes_ = first_followed_ = map_.keyframes.size();
  is_map_fixed_ = is_map_fixed;
  std::uint16_t last_session = 0;
  for (const auto& frame : known.extras.frames)
    last_session = std::max(last_session, frame.frame.session());
  // a session that was killed at its first keyframe has no frame yet
  for (std::size_t i = 0; i < map_.keyframes.size(); ++i)
    last_session = std::max(last_session, map_.keyframes[i].view.frame.session());
  for (const auto& descriptor : known.extras.descriptors)
    last_session = std::max(last_session, descriptor.frame.session());
  session_ = static_cast<std::uint16_t>(last_session + 1);
}

void Tracking::feed(const core::Frame& frame) {
  core::require(frame.id == core::FrameId(frames_.size(), session_),
                "frames are numbered from 0, in the session that runs");
  std::optional<scene::TrackedView> tracked;
  {
    const core::ScopedTimer timer(timings_, "track");
    if (under_way_ && under_way_->due_at_frame <= frames_.size()) see_kept();
    const features::View view = extract(frame);
    tracked = locate(frame, view);
    frames_.push_back(tracked ? by_odometry(tracked->pose)
                              : core::FramePose{.frame = view.frame,
                                                .stamp_s = view.stamp_s,
                                                .status = status_without_pose(view)});
    if (tracked && !is_map_fixed_) passing_.see(frame, frames_.back());
  }
  if (!tracked || is_map_fixed_ || under_way_ || is_kept(*tracked)) return;
  if (map::is_worth_keeping(map_, *tracked, config_.map)) {
    keep(*tracked, frame.images[0]);
  } else if (frames_.size() - num_sent_frames_ >= kMaxUnsentFrames) {
    mapping_.send(SaveFrames{unsent_frames()});
  }
}

features::View Tracking::extract(const core::Frame& frame) {
  const core::ScopedTimer timer(timings_, "features");
  return features::extract(frame, config_.features);
}

void Tracking::finish() {
  if (under_way_) see_kept();
  mapping_.send(EndOfInput{unsent_frames()});
}

std::optional<scene::TrackedView> Tracking::locate(const core::Frame& frame,
                                                   const features::View& view) {
  if (map_.keyframes.empty()) return start(frame, view);
  auto tracked = last_ ? locate_in_map(frame, view) : relocalise(frame, view);
  if (!tracked && !last_ && is_start_doubtful(view.stamp_s)) {
    if (auto started = start_anew(frame, view)) return started;
  }
  num_lost_ = tracked ? 0 : num_lost_ + 1;
  if (tracked) {
    if (starter_) starter_->forget();
    follow(*tracked);
    doubt_scale(*tracked);
    remember(*tracked);
    last_depth_m_ = frame.depth_m;
  } else {
    last_.reset();
    first_followed_ = num_keyframes_;
  }
  return tracked;
}

std::optional<scene::TrackedView> Tracking::locate_in_map(const core::Frame& frame,
                                                          const features::View& view) {
  std::optional<scene::TrackedView> best = track_from_last(view);
  if ((!best || is_weak(*best)) && under_way_) {
    see_kept();
    try_again(view, best);
  }
  if ((!best || is_weak(*best)) && can_promote_last()) {
    // the reference is too far away: what the last frame saw is nearer
    keep(*last_, {});
    see_kept();
    try_again(view, best);
  }
  if (best && best->pose.num_inliers >= config_.track.sure_inliers) return best;
  auto held = held_by_depth(frame, view);
  const bool is_better = held && (!best || is_weak(*best) ||
                                  track::are_apart(world_from(best->pose), world_from(held->pose)));
  return is_better ? held : best;
}

std::optional<scene::TrackedView> Tracking::held_by_depth(const core::Frame& frame,
                                                          const features::View& view) {
  constexpr double kAll = 1.0;
  const bool is_asked = config_.track.depth_alignment.min_agreement <= kAll;
  if (!is_asked || !frame.depth_m || !last_depth_m_ || local_map_.size() == 0) return std::nullopt;
  const core::ScopedTimer timer(timings_, "depth alignment");
  const core::Camera& camera = view.rig->cameras[0];
  const core::Rigid3& body_from_camera = view.rig->body_from_camera[0];
  const core::Rigid3 camera_from_body = inverse(body_from_camera);
  const track::DepthAlignmentConfig& config = config_.track.depth_alignment;
  const auto aligned = track::align({*last_depth_m_, camera, config.max_step_ratio},
                                    {*frame.depth_m, camera, config.max_step_ratio},
                                    camera_from_body * last_from_next_ * body_from_camera, config);
  if (!aligned) return std::nullopt;
  const core::Rigid3 reference_from_last =
      inverse(world_from_body(map_, local_map_.reference)) * world_from(last_->pose);
  const core::Rigid3 last_from_this =
      body_from_camera * aligned->earlier_from_later * camera_from_body;
  return tracked_view(
      view, tracker_.track_at(view, local_map_, reference_from_last * last_from_this, *aligned));
}

std::optional<scene::TrackedView> Tracking::track_from_last(const features::View& view) {
  if (local_map_.size() == 0) return std::nullopt;  // nobody knows where to look
  const auto track = tracker_.track(view, local_map_, guessed_pose());
  if (!track) return std::nullopt;
  return tracked_view(view, *track);
}

void Tracking::try_again(const features::View& view, std::optional<scene::TrackedView>& best) {
  auto nearer = track_from_last(view);
  if (nearer && (!best || nearer->pose.num_inliers > best->pose.num_inliers))
    best = std::move(nearer);
}

std::optional<scene::TrackedView> Tracking::relocalise(const core::Frame& frame,
                                                       const features::View& view) {
  mapping_.send(FindPlace{view, frame.images[0]});
  MapAnswer answer = wait_for_mapping();
  const bool has_changed = answer.map.number != map_.number;
  map_ = std::move(answer.map);
  if (has_changed && local_map_.size() > 0)
    look_around(holder_of(map_, local_map_.reference).keyframe);
  // where he was last is a place like any other
  if (local_map_.size() > 0) answer.places.push_back({local_map_.reference, std::nullopt, true});
  auto found =
      place_finder_.look(view, map_, answer.places, proof_to_resume(view.stamp_s),
                         [this](const core::FramePose& pose) { return is_within_reach(pose); });
  if (!found) return std::nullopt;
  local_map_ = std::move(found->around);
  scene::TrackedView tracked = tracked_view(view, found->track);
  tracked.pose.status = core::FrameStatus::kResumed;
  return tracked;
}

const core::FramePose* Tracking::last_measured() const {
  const auto last = std::find_if(frames_.rbegin(), frames_.rend(),
                                 [](const core::FramePose& frame) { return frame.is_measured; });
  return last == frames_.rend() ? nullptr : &*last;
}

bool Tracking::is_within_reach(const core::FramePose& pose) const {
  constexpr double kAnyhow_m = 0.5;  // the map may have moved
  const core::FramePose* last = last_measured();
  if (last == nullptr || is_without_depth(map_)) return true;
  const double way_m = (world_from(pose).translation - world_from(*last).translation).norm();
  return way_m <=
         kAnyhow_m + config_.track.relocalization.max_speed_m_s * (pose.stamp_s - last->stamp_s);
}

Proof Tracking::proof_to_resume(double stamp_s) const {
  constexpr double kMoment_s = 1.0;
  const core::FramePose* last = last_measured();
  const bool is_moment = last != nullptr && stamp_s - last->stamp_s <= kMoment_s;
  // without depth nothing is beyond reach: a weak pose may be anywhere
  return {is_moment ? 1 : config_.track.relocalization.min_views,
          is_moment && !is_without_depth(map_)};
}

void Tracking::follow(scene::TrackedView& tracked) {
  std::vector<core::LandmarkId> seen;
  for (const auto& [feature, landmark] : tracked.landmarks) seen.push_back(landmark);
  const auto most = keyframe_showing_most(map_, seen);
  if (!most) return;
  if (*most != local_map_.reference) look_around(*most);
  core::FramePose& pose = tracked.pose;
  if (*most != pose.reference_keyframe) pose = relative_to(*most, pose);
}

core::FramePose Tracking::relative_to(core::KeyframeId reference, core::FramePose pose) const {
  const core::Rigid3 from_old =
      inverse(world_from_body(map_, reference)) * world_from_body(map_, pose.reference_keyframe);
  pose.information = track::seen_from(from_old, pose.information);
  pose.reference_from_frame = inverse(world_from_body(map_, reference)) * world_from(pose);
  pose.reference_keyframe = reference;
  pose.log_scale = map_.at(reference).log_scale;
  return pose;
}

core::FramePose Tracking::by_odometry(const core::FramePose& pose) {
  const core::KeyframeId newest = map_.keyframes.back().id;
  const core::KeyframeId reference = holder_of(map_, pose.reference_keyframe).keyframe;
  if (newest.index() < first_followed_ || newest == reference || map_.loops.empty()) return pose;
  const Way way{map_.number, newest, reference};
  if (!last_way_ || last_way_->first != way)
    last_way_ = {way, shortest_path_uses_loop(map_, newest, reference)};
  return last_way_->second ? relative_to(newest, pose) : pose;
}

// The last step once more, relative to the reference of the local map.
core::Rigid3 Tracking::guessed_pose() const {
  return inverse(world_from_body(map_, local_map_.reference)) * world_from(last_->pose) *
         last_from_next_;
}

void Tracking::remember(const scene::TrackedView& tracked) {
  last_from_next_ =
      last_ ? inverse(world_from(last_->pose)) * world_from(tracked.pose) : core::Rigid3{};
  last_ = tracked;
}

void Tracking::doubt_scale(scene::TrackedView& tracked) {
  if (!last_ || !is_without_depth(map_)) return;
  const double step =
      (world_from(tracked.pose).translation - world_from(last_->pose).translation).norm();
  const auto factor =
      scale_watch_.see(tracked.pose.stamp_s, step, map::median_landmark_depth(map_, tracked));
  if (!factor) return;
  core::FramePose& pose = tracked.pose;
  if (pose.status == core::FrameStatus::kTracking) {
    pose.status = core::FrameStatus::kWeak;
    pose.information /= config_.track.drift.weak_factor * config_.track.drift.weak_factor;
  }
  track::note_doubt(scale_doubts_, pose.frame, *factor);
}

core::FrameStatus Tracking::status_without_pose(const features::View& view) const {
  if (!map_.keyframes.empty()) return core::FrameStatus::kLost;
  if (view.features->size() < config_.map.min_landmarks)
    return core::FrameStatus::kWaitingForFeatures;
  return starter_ ? core::FrameStatus::kWaitingForParallax : core::FrameStatus::kWaitingForDepth;
}

bool Tracking::can_promote_last() const {
  return !is_map_fixed_ && last_ && !is_kept(*last_) &&
         map::can_keep(map_, last_->view, config_.map);
}

void Tracking::keep(const scene::TrackedView& tracked, const cv::Mat& image) {
  core::FramePose& pose = frames_.back();
  core::require(pose.frame == tracked.view.frame, "the frame that is kept is the last one");
  const core::KeyframeId added(num_keyframes_++);
  keyframe_of_[pose.frame] = added;
  // from now on the frame is where its keyframe is, wherever a loop moves it
  pose.reference_keyframe = added;
  pose.reference_from_frame = core::Rigid3{};
  const std::size_t position = frames_.size() - 1;
  scene::TrackedView followed = tracked;
  followed.passing = passing_.shown_in(tracked.view, tracked.pose, map_);
  followed.pose = by_odometry(tracked.pose);
  mapping_.send(AddKeyframe{std::move(followed), image, unsent_frames()});
  under_way_ = {added, position + static_cast<std::size_t>(config_.map.visible_after_frames)};
}

void Tracking::see_kept() {
  scene::MapVersion map = wait_for_mapping().map;
  if (map.loops.size() != map_.loops.size()) scale_watch_.forget();
  // the reference may be at the other end of the loop
  if (last_ && has_lost_a_loop(map_, map)) last_->pose = by_odometry(last_->pose);
  map_ = std::move(map);
  const core::KeyframeId kept = std::exchange(under_way_, std::nullopt)->keyframe;
  look_around(kept);
  if (last_ && last_->view.frame == map_.at(kept).view.frame) {
    last_->pose.reference_keyframe = kept;
    last_->pose.reference_from_frame = core::Rigid3{};
  }
}

MapAnswer Tracking::wait_for_mapping() {
  const core::ScopedTimer timer(timings_, "wait for mapping");
  return mapping_.receive();
}

void Tracking::look_around(core::KeyframeId reference) {
  local_map_ = map::local_map(map_, reference, config_.map);
}

bool Tracking::is_kept(const scene::TrackedView& tracked) const {
  return keyframe_of_.contains(tracked.view.frame);
}

core::Rigid3 Tracking::world_from(const core::FramePose& pose) const {
  return world_from_frame(map_, pose);
}

scene::TrackedView Tracking::tracked_view(const features::View& view,
                                          const track::Track& track) const {
  scene::TrackedView tracked{view, track.pose, {}, {}};
  tracked.pose.log_scale = map_.at(track.pose.reference_keyframe).log_scale;
  for (const auto& match : track.matches) {
    tracked.landmarks.emplace_back(match.second,
                                   local_map_.landmarks[static_cast<std::size_t>(match.first)]);
  }
  return tracked;
}

std::vector<core::FramePose> Tracking::unsent_frames() {
  const auto first = static_cast<std::ptrdiff_t>(std::exchange(num_sent_frames_, frames_.size()));
  return {frames_.begin() + first, frames_.end()};
}

}  // namespace samewhere::pipeline
