#include <algorithm>
#include <utility>

#include <samewhere/map/mapper.hpp>
#include <samewhere/pipeline/motion_prediction.hpp>
#include <samewhere/pipeline/provisional.hpp>

namespace samewhere::pipeline {
namespace {

// A view counts as evidence after so much motion.
constexpr double kStep_m = 0.2;
constexpr double kStep_rad = 0.35;
constexpr double kRetrieval_m = 0.5;  // between two retrievals
constexpr std::size_t kMaxProvisional = 8;
constexpr int kMaxFailures = 3;       // evaluations of a hypothesis without a pose
constexpr int kMaxUnmeasured = 15;    // views
constexpr int kMinComparedViews = 2;  // to follow another hypothesis
constexpr double kOvertakes = 1.15;   // inliers of another hypothesis, over those of the best

// `metre`: in map units.
bool is_step(const core::Rigid3& motion, double metre) {
  return motion.translation.norm() >= kStep_m * metre ||
         core::angle_rad(motion.rotation) >= kStep_rad;
}

// Sees the same from another keyframe.
void move_to(Place& known, const Place& place) {
  const bool is_recognised = known.is_recognised || place.is_recognised;
  known = place;
  known.is_recognised = is_recognised;
}

// The features of a view as landmarks, for odometry from view to view.
scene::LocalMap local_map_of(const features::View& view) {
  scene::LocalMap local;
  const features::Features& features = *view.features;
  const core::Rigid3& body_from_camera = view.rig->body_from_camera[0];
  std::vector<int> chosen;
  for (int i = 0; i < features.size(); ++i) {
    const auto point = features::point_in_camera(view, i);
    if (!point) continue;
    chosen.push_back(i);
    local.landmarks.emplace_back(static_cast<std::uint64_t>(i));
    local.points_in_reference.push_back(body_from_camera * *point);
    local.range_m.push_back(point->norm());
    local.octave.push_back(features.octave[static_cast<std::size_t>(i)]);
  }
  local.descriptors = cv::Mat(static_cast<int>(chosen.size()), 32, CV_8U);
  for (std::size_t k = 0; k < chosen.size(); ++k)
    features.descriptors.row(chosen[k]).copyTo(local.descriptors.row(static_cast<int>(k)));
  local.num_near = local.size();
  return local;
}

}  // namespace

ProvisionalRelocalization::ProvisionalRelocalization(const Config& config,
                                                     const track::Tracker& tracker)
    : config_(config), tracker_(tracker) {}

void ProvisionalRelocalization::begin(LeadingHypotheses leading, double log_ratio_by_motion,
                                      const features::View& view) {
  hypotheses_.clear();
  PlaceHypothesis first(config_.track.relocalization.common_length_m);
  first.place = place_of(leading.best);
  first.place.is_recognised = true;
  first.pose = std::move(leading.best);
  first.log_ratio_by_motion = log_ratio_by_motion;
  hypotheses_.push_back(std::move(first));
  for (const Place& place : leading.others) {
    hypotheses_.emplace_back(config_.track.relocalization.common_length_m).place = place;
    hypotheses_.back().since_step_m = kStep_m;  // evaluated soon
    hypotheses_.back().since_step.translation.x() = kStep_m;
  }
  last_view_ = view;
  last_motion_ = {};
  note_asked();
  num_unmeasured_ = 0;
}

bool ProvisionalRelocalization::wants_places() const {
  if (!is_active()) return false;
  return since_asked_m_ >= kRetrieval_m || num_unmeasured_ > 0 ||
         log_ratio(hypotheses_.front(), hypotheses_, config_.track.weak_inliers) >=
             config_.track.relocalization.min_log_ratio;
}

void ProvisionalRelocalization::note_asked() {
  since_asked_ = {};
  since_asked_m_ = 0.0;
}

void ProvisionalRelocalization::track(PlaceHypothesis& hypothesis, const Query& query) const {
  const scene::MapVersion& map = query.map;
  const Place& place = hypothesis.place;
  const core::KeyframeId keyframe = hypothesis.pose ? nearest_keyframe(map, *hypothesis.pose)
                                                    : holder_of(map, place.keyframe).keyframe;
  const bool has_map = hypothesis.pose && hypothesis.pose->local_map.reference == keyframe;
  scene::LocalMap local_map =
      has_map ? std::move(hypothesis.pose->local_map) : map::local_map(map, keyframe, config_.map);
  const core::Rigid3 guess =
      inverse(scene::world_from_body(map, keyframe)) * world_from_body(map, place);
  auto found = tracker_.track(query.view, local_map, guess);
  hypothesis.pose.reset();
  if (!found) return;
  RelocalizedPose pose{std::move(local_map), std::move(*found)};
  if (are_one_place(map, place, place_of(pose), median_distance(pose)))
    hypothesis.pose = std::move(pose);
}

core::Rigid3 ProvisionalRelocalization::estimate_motion(const Place& before, const Query& query) {
  PlaceHypothesis& leader = best();
  if (leader.pose)
    return inverse(world_from_body(query.map, before)) *
           world_from_body(query.map, place_of(*leader.pose));
  const scene::LocalMap last = local_map_of(last_view_);
  if (last.size() == 0) return last_motion_;
  const auto track = tracker_.track(query.view, last, last_motion_);
  return track ? track->pose.reference_from_frame : last_motion_;
}

void ProvisionalRelocalization::advance(const core::Rigid3& last_from_this, const Query& query) {
  const double moved_m = last_from_this.translation.norm() / metre_of(query.map);
  for (PlaceHypothesis& hypothesis : hypotheses_) {
    const bool is_measured = &hypothesis == &best() && hypothesis.pose;
    const bool is_recognised = hypothesis.place.is_recognised;
    if (is_measured)
      hypothesis.place = place_of(*hypothesis.pose);
    else
      hypothesis.place.keyframe_from_body =
          hypothesis.place.keyframe_from_body.value_or(core::Rigid3{}) * last_from_this;
    hypothesis.place.is_recognised = is_recognised;
    hypothesis.since_step = hypothesis.since_step * last_from_this;
    hypothesis.since_step_m += moved_m;
  }
  since_asked_ = since_asked_ * last_from_this;
  since_asked_m_ += moved_m;
  last_motion_ = last_from_this;
  last_view_ = query.view;
}

// The one that waits for longest, so that no frame takes much longer than another.
void ProvisionalRelocalization::evaluate_one_other(const Query& query) {
  const auto next = std::max_element(hypotheses_.begin() + 1, hypotheses_.end(),
                                     [](const PlaceHypothesis& a, const PlaceHypothesis& b) {
                                       return a.since_step_m < b.since_step_m;
                                     });
  if (next == hypotheses_.end() || !is_step(next->since_step, metre_of(query.map))) return;
  track(*next, query);
  const bool is_recognised = next->place.is_recognised;
  if (next->pose) next->place = place_of(*next->pose);
  next->place.is_recognised = is_recognised;
  next->add_step(query.view, query.map, config_.map, found_ratios_);
  best().add_view(query.view, query.map, config_.map);
  // the pose of the first view is a coarse one
  const bool are_measured = best().pose && next->pose && next->views.size() > 1 &&
                            best().pose->track.pose.frame == query.view.frame;
  if (are_measured)
    next->differences.add(query.view, {best().views.back(), *best().pose},
                          {next->views.back(), *next->pose});
  if (next->num_failures >= kMaxFailures) hypotheses_.erase(next);
}

// Hypotheses that have become one place: the better evidence is kept.
void ProvisionalRelocalization::merge_equal(const scene::MapVersion& map) {
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    PlaceHypothesis& kept = hypotheses_[i];
    for (std::size_t k = hypotheses_.size() - 1; k > i; --k) {
      PlaceHypothesis& other = hypotheses_[k];
      if (!kept.pose || !other.pose || other.views.empty() ||
          !are_one_place(map, kept.place, other.place, median_distance(*kept.pose)))
        continue;
      kept.place.is_recognised |= other.place.is_recognised;
      kept.log_ratio_by_motion = std::max(kept.log_ratio_by_motion, other.log_ratio_by_motion);
      if (other.evidence.log_likelihood_ratio() > kept.evidence.log_likelihood_ratio()) {
        kept.evidence = other.evidence;
        kept.new_ground = std::move(other.new_ground);
        kept.views = std::move(other.views);
        kept.seen = std::move(other.seen);
      }
      hypotheses_.erase(hypotheses_.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }
}

void ProvisionalRelocalization::add_places(const std::vector<Place>& places, const Query& query) {
  for (Place place : places) {
    if (!place.keyframe_from_body) continue;
    place.keyframe_from_body = *place.keyframe_from_body * since_asked_;
    const double distance = best().pose ? median_distance(*best().pose) : 0.0;
    const auto same = std::ranges::find_if(hypotheses_, [&](const PlaceHypothesis& known) {
      return are_one_place(query.map, known.place, place, distance);
    });
    if (same != hypotheses_.end()) {
      same->place.is_recognised |= place.is_recognised;
      // where it was, the map ends
      if (same->pose && same->is_in_map()) continue;
      move_to(same->place, place);
      same->pose.reset();
      continue;
    }
    if (hypotheses_.size() >= kMaxProvisional) continue;
    PlaceHypothesis next(config_.track.relocalization.common_length_m);
    next.place = place;
    next.since_step_m = kStep_m;
    next.since_step.translation.x() = kStep_m;
    hypotheses_.push_back(std::move(next));
  }
}

std::optional<core::Rigid3> ProvisionalRelocalization::switch_best(const scene::MapVersion& map) {
  const auto overtakes = [&](const PlaceHypothesis& other) {
    if (!other.pose || !other.place.is_recognised) return false;
    if (num_unmeasured_ >= kMinComparedViews) return true;
    if (other.differences.is_there()) return true;
    const ComparedCounts sums = compare(other.views, best().views);
    return sums.num_views >= kMinComparedViews &&
           sums.a.num_inliers > kOvertakes * sums.b.num_inliers;
  };
  const auto next = std::find_if(hypotheses_.begin() + 1, hypotheses_.end(), overtakes);
  if (next == hypotheses_.end()) return std::nullopt;
  const core::Rigid3 new_from_old =
      world_from_body(map, next->place) * inverse(world_from_body(map, best().place));
  PlaceDifferences differences = next->differences.swapped();
  for (PlaceHypothesis& hypothesis : hypotheses_) hypothesis.differences = {};
  best().differences = std::move(differences);
  std::iter_swap(hypotheses_.begin(), next);
  num_unmeasured_ = 0;
  return new_from_old;
}

bool ProvisionalRelocalization::has_untracked_recognition(const std::vector<Place>& places,
                                                          const scene::MapVersion& map) const {
  return std::ranges::any_of(places, [&](const Place& place) {
    if (!place.is_recognised || !place.keyframe_from_body) return false;
    const Place now{place.keyframe, *place.keyframe_from_body * since_asked_, true};
    return std::ranges::none_of(hypotheses_, [&](const PlaceHypothesis& hypothesis) {
      return hypothesis.pose &&
             are_one_place(map, hypothesis.place, now, median_distance(*hypothesis.pose));
    });
  });
}

ProvisionalRelocalization::Decision ProvisionalRelocalization::decide(
    const std::vector<Place>* places, const Query& query) const {
  const PlaceHypothesis& leader = hypotheses_.front();
  const double required = config_.track.relocalization.min_log_ratio;
  const double ratio = log_ratio(leader, hypotheses_, config_.track.weak_inliers);
  if (ratio <= -required || num_unmeasured_ >= kMaxUnmeasured) return Decision::kTakenBack;
  const bool is_measured = leader.pose && leader.pose->track.pose.frame == query.view.frame;
  if (ratio < required || places == nullptr || !is_measured) return Decision::kOpen;
  if (leader.pose->track.pose.status == core::FrameStatus::kWeak) return Decision::kOpen;
  if (!is_alone(leader, hypotheses_, config_.track.weak_inliers) ||
      has_untracked_recognition(*places, query.map))
    return Decision::kOpen;
  return Decision::kConfirmed;
}

core::FramePose ProvisionalRelocalization::pose_of(const PlaceHypothesis& hypothesis,
                                                   const Query& query) {
  core::FramePose pose;
  if (hypothesis.pose && hypothesis.pose->track.pose.frame == query.view.frame)
    pose = hypothesis.pose->track.pose;
  pose.frame = query.view.frame;
  pose.stamp_s = query.view.stamp_s;
  pose.status = core::FrameStatus::kProvisional;
  pose.is_measured = true;
  pose.reference_keyframe = hypothesis.place.keyframe;
  pose.reference_from_frame = hypothesis.place.keyframe_from_body.value_or(core::Rigid3{});
  pose.log_scale = query.map.at(pose.reference_keyframe).log_scale;
  return pose;
}

ProvisionalRelocalization::Result ProvisionalRelocalization::evaluate(
    const features::View& view, const scene::MapVersion& map, const std::vector<Place>* places) {
  const Query query{view, map};
  const Place before = best().place;
  best().place.keyframe_from_body =
      best().place.keyframe_from_body.value_or(core::Rigid3{}) * last_motion_;
  track(best(), query);
  const core::Rigid3 motion = estimate_motion(before, query);
  best().place = before;
  advance(motion, query);
  num_unmeasured_ = best().pose ? 0 : num_unmeasured_ + 1;
  if (is_step(best().since_step, metre_of(map)))
    best().add_step(view, map, config_.map, found_ratios_);
  if (hypotheses_.size() > 1) evaluate_one_other(query);
  merge_equal(map);
  if (places != nullptr) add_places(*places, query);
  Result result{
      .decision = Decision::kOpen, .confirmed = {}, .pose = {}, .new_from_old = switch_best(map)};
  result.decision = decide(places, query);
  result.pose = pose_of(best(), query);
  if (result.decision == Decision::kConfirmed) result.confirmed = std::move(best().pose);
  if (result.decision != Decision::kOpen) reset();
  return result;
}

}  // namespace samewhere::pipeline
