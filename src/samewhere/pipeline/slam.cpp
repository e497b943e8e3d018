#include <samewhere/correct/loop_corrector.hpp>
#include <samewhere/features/orb.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/verify/measure_odometry.hpp>

namespace samewhere::pipeline {

Slam::Slam(const Config& config)
    : config_(config),
      tracker_({config.track, config.features, config.optimize,
                static_cast<std::uint64_t>(config.seed)}),
      detector_(config) {}

void Slam::feed(const core::Frame& frame) {
  features::View view;
  std::optional<map::TrackedView> tracked;
  {
    const core::ScopedTimer timer(timings_, "track");
    view = features::extract(frame, config_.features);
    tracked = locate(view);
  }
  if (!tracked) {
    frames_.push_back({.frame = view.frame, .stamp_s = view.stamp_s});
    return;
  }
  frames_.push_back(tracked->pose);
  const bool is_first = tracked->pose.status == core::FrameStatus::kStarting;
  if (is_first || map::is_worth_keeping(map_, *tracked, config_.map)) {
    if (!is_first) keep(*tracked);
    look_for_loops(frame, view);
  }
}

std::optional<map::TrackedView> Slam::locate(const features::View& view) {
  if (map_.keyframes.empty()) {
    if (!map::can_start(view, config_.map)) return std::nullopt;
    start(view);
    return last_;
  }
  auto tracked = locate_in_map(view);
  if (tracked) {
    remember(*tracked);
  } else {
    last_.reset();
  }
  return tracked;
}

std::optional<map::TrackedView> Slam::locate_in_map(const features::View& view) {
  std::optional<map::TrackedView> best = track_from_last(view);
  const bool is_poor = !best || best->pose.status == core::FrameStatus::kWeak;
  const bool can_promote = last_ && !keyframe_of_.contains(last_->view.frame) &&
                           map::num_with_depth(last_->view) >= config_.map.min_landmarks;
  if (is_poor && can_promote) {
    // the reference is too far away: what the last frame saw is nearer
    keep(*last_);
    auto nearer = track_from_last(view);
    if (nearer && (!best || nearer->pose.num_inliers > best->pose.num_inliers)) best = nearer;
  }
  if (best && !last_) best->pose.status = core::FrameStatus::kResumed;
  return best;
}

std::optional<map::TrackedView> Slam::track_from_last(const features::View& view) {
  const auto track = last_ ? tracker_.track(view, local_map_, guessed_pose())
                           : tracker_.track_anywhere(view, local_map_);
  if (!track) return std::nullopt;
  return tracked_view(view, *track);
}

// The last step once more, relative to the reference of the local map.
core::Rigid3 Slam::guessed_pose() const {
  const core::Rigid3 world_from_last =
      map_.at(last_->pose.reference_keyframe).world_from_body * last_->pose.reference_from_frame;
  return inverse(map_.at(local_map_.reference).world_from_body) * world_from_last * last_from_next_;
}

// The motion of this frame against the last, relative to one keyframe.
void Slam::remember(const map::TrackedView& tracked) {
  last_from_next_ = core::Rigid3{};
  if (last_) {
    const core::Rigid3 world_from_last =
        map_.at(last_->pose.reference_keyframe).world_from_body * last_->pose.reference_from_frame;
    const core::Rigid3 world_from_this = map_.at(tracked.pose.reference_keyframe).world_from_body *
                                         tracked.pose.reference_from_frame;
    last_from_next_ = inverse(world_from_last) * world_from_this;
  }
  last_ = tracked;
}

void Slam::start(const features::View& view) {
  apply(map::start_map(map_, view, core::Rigid3{}));
  const core::KeyframeId first = map_.keyframes.back().id;
  keyframe_of_[view.frame] = first;
  local_map_ = scene::build_local_map(map_, first, config_.map.max_neighbours);
  map::TrackedView tracked{view, {}, {}};
  tracked.pose = {.frame = view.frame,
                  .stamp_s = view.stamp_s,
                  .status = core::FrameStatus::kStarting,
                  .is_measured = true,
                  .reference_keyframe = first,
                  .num_inliers = map::num_with_depth(view)};
  last_ = tracked;
}

void Slam::keep(const map::TrackedView& tracked) {
  const core::ScopedTimer timer(timings_, "map");
  apply(map::add_keyframe(map_, tracked));
  const core::KeyframeId added = map_.keyframes.back().id;
  keyframe_of_[tracked.view.frame] = added;
  local_map_ = scene::build_local_map(map_, added, config_.map.max_neighbours);
  // from now on the frame is where its keyframe is, wherever a loop moves it
  for (core::FramePose* pose : {&last_->pose, &frames_.back()}) {
    core::require(pose->frame == tracked.view.frame, "the frame that is kept is the last one");
    pose->reference_keyframe = added;
    pose->reference_from_frame = core::Rigid3{};
  }
}

void Slam::look_for_loops(const core::Frame& frame, const features::View& view) {
  const auto measure_odometry = [&](const core::Candidate& candidate,
                                    const core::Sim3& match_from_query) {
    return std::optional(verify::measure_odometry(map_, keyframe_of_.at(candidate.query),
                                                  keyframe_of_.at(candidate.match),
                                                  rigid_part(match_from_query), config_.verify));
  };
  const std::vector<core::LedgerRow> rows =
      detector_.look(frame.images[0], view, measure_odometry, timings_);
  ledger_.insert(ledger_.end(), rows.begin(), rows.end());
  correct(rows);
}

void Slam::correct(const std::vector<core::LedgerRow>& rows) {
  const core::ScopedTimer timer(timings_, "correct");
  for (const auto& row : rows) {
    const auto* loop = std::get_if<core::LoopClosure>(&row.verdict);
    if (loop == nullptr || !loop->match_from_query) continue;
    const scene::LoopEdge edge{
        keyframe_of_.at(row.candidate.query), keyframe_of_.at(row.candidate.match),
        rigid_part(*loop->match_from_query), loop->information, loop->candidate};
    apply(correct::close_loop(map_, edge, config_.optimize));
    local_map_ = scene::build_local_map(map_, local_map_.reference, config_.map.max_neighbours);
  }
}

map::TrackedView Slam::tracked_view(const features::View& view, const track::Track& track) const {
  map::TrackedView tracked{view, track.pose, {}};
  for (const auto& match : track.matches) {
    tracked.landmarks.emplace_back(match.second,
                                   local_map_.landmarks[static_cast<std::size_t>(match.first)]);
  }
  return tracked;
}

void Slam::apply(const scene::Edit& edit) { map_ = scene::apply(std::move(map_), edit); }

namespace {

// Frames placed in the world by their reference keyframes.
template <class WorldFromKeyframe>
core::Trajectory placed(const scene::MapVersion& map, const std::vector<core::FramePose>& frames,
                        const WorldFromKeyframe& world_from_keyframe) {
  core::Trajectory trajectory;
  for (const auto& frame : frames) {
    if (!frame.is_measured) continue;
    const core::Rigid3& body_from_camera =
        map.at(frame.reference_keyframe).view.rig->body_from_camera[0];
    trajectory.push_back({frame.stamp_s, world_from_keyframe(frame.reference_keyframe) *
                                             frame.reference_from_frame * body_from_camera});
  }
  return trajectory;
}

}  // namespace

core::Trajectory trajectory_of(const scene::MapVersion& map,
                               const std::vector<core::FramePose>& frames) {
  return placed(map, frames, [&](core::KeyframeId id) { return map.at(id).world_from_body; });
}

core::Trajectory odometry_of(const scene::MapVersion& map,
                             const std::vector<core::FramePose>& frames) {
  const std::vector<core::Rigid3> world_from_body = scene::odometry_poses(map);
  return placed(map, frames, [&](core::KeyframeId id) { return world_from_body[id.index()]; });
}

}  // namespace samewhere::pipeline
