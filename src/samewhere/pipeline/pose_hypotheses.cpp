#include <algorithm>
#include <utility>

#include <samewhere/core/median.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/map/mapper.hpp>
#include <samewhere/pipeline/pose_hypotheses.hpp>

namespace samewhere::pipeline {
namespace {

// Fewer would lose a place while the camera looks beyond the end of its map; more would delay
// relocalization after the camera has left a look-alike place.
constexpr std::size_t kRememberedViews = 30;
constexpr std::size_t kMaxHypotheses = 8;
// Of the visible landmarks of the hypothesis with most: with fewer, the map ends there.
constexpr double kMinVisibleRatio = 0.5;
// Of the inliers of a hypothesis: if fewer lie in comparable cells, the two are undecided.
constexpr double kMinComparedRatio = 0.25;

int num_inliers(const RelocalizedPose& pose) { return pose.track.pose.num_inliers; }

// Recognized by the loop verifier, with a relative pose.
bool is_recognized_and_reachable(const Place& place, const features::View& view,
                                 const IsReachable& is_reachable) {
  if (!place.is_recognised || !place.keyframe_from_body) return false;
  core::FramePose pose;
  pose.frame = view.frame;
  pose.stamp_s = view.stamp_s;
  pose.reference_keyframe = place.keyframe;
  pose.reference_from_frame = *place.keyframe_from_body;
  return is_reachable(pose);
}

}  // namespace

void PoseHypotheses::track_in_local_map(core::KeyframeId keyframe, const Place& place,
                                        const Query& query, TrackedPlace& tracked) const {
  const scene::MapVersion& map = query.map;
  const scene::LocalMap local_map = map::local_map(map, keyframe, map_config_);
  const auto offer = [&](std::optional<track::Track> track) {
    if (!track || !query.is_reachable(track->pose)) return;
    RelocalizedPose next{local_map, std::move(*track)};
    const bool is_near = !place.keyframe_from_body ||
                         are_one_place(map, place, place_of(next), median_distance(next));
    auto& best = is_near ? tracked.near : tracked.elsewhere;
    if (!best || num_inliers(next) > num_inliers(*best)) best = std::move(next);
  };
  if (place.keyframe_from_body) {
    const core::Rigid3 guess =
        inverse(scene::world_from_body(map, keyframe)) * world_from_body(map, place);
    offer(tracker_.track(query.view, local_map, guess));
  }
  offer(tracker_.track_anywhere(query.view, local_map));
}

PoseHypotheses::TrackedPlace PoseHypotheses::track_at(const Place& place,
                                                      const Query& query) const {
  const scene::MapVersion& map = query.map;
  TrackedPlace tracked;
  const core::KeyframeId first = holder_of(map, place.keyframe).keyframe;
  track_in_local_map(first, place, query, tracked);
  if (!tracked.near) return tracked;
  const core::KeyframeId nearest = nearest_keyframe(map, *tracked.near);
  if (nearest != first) track_in_local_map(nearest, place_of(*tracked.near), query, tracked);
  return tracked;
}

void PoseHypotheses::update(Hypothesis& hypothesis, const Query& query,
                            std::vector<Place>& elsewhere) const {
  TrackedPlace tracked = track_at(hypothesis.place, query);
  hypothesis.pose = std::move(tracked.near);
  if (hypothesis.pose) {
    const bool is_recognised = hypothesis.place.is_recognised;
    hypothesis.place = place_of(*hypothesis.pose);
    hypothesis.place.is_recognised = is_recognised;
  }
  if (tracked.elsewhere) elsewhere.push_back(place_of(*tracked.elsewhere));
}

void PoseHypotheses::add(const Place& place, const Query& query) {
  for (Hypothesis& known : hypotheses_) {
    if (!known.pose || !are_one_place(query.map, known.place, place, median_distance(*known.pose)))
      continue;
    known.place.is_recognised |= place.is_recognised;
    return;
  }
  TrackedPlace tracked = track_at(place, query);
  if (!tracked.near) return;
  Hypothesis next{place_of(*tracked.near), {}, std::move(tracked.near)};
  next.place.is_recognised = place.is_recognised;
  hypotheses_.push_back(std::move(next));
}

int PoseHypotheses::Hypothesis::num_inliers() const {
  int count = 0;
  for (const ViewEvidence& of_view : evidence)
    count += of_view.is_comparable ? of_view.total.num_inliers : 0;
  return count;
}

// Of equal hypotheses the one with most inliers is kept.
void PoseHypotheses::merge_equal(const scene::MapVersion& map) {
  std::stable_sort(
      hypotheses_.begin(), hypotheses_.end(), [](const Hypothesis& a, const Hypothesis& b) {
        return a.evidence.back().total.num_inliers > b.evidence.back().total.num_inliers;
      });
  std::vector<Hypothesis> distinct;
  for (Hypothesis& next : hypotheses_) {
    const auto same = std::find_if(distinct.begin(), distinct.end(), [&](const Hypothesis& other) {
      return next.pose && other.pose &&
             are_one_place(map, other.place, next.place, median_distance(*other.pose));
    });
    if (same == distinct.end()) {
      distinct.push_back(std::move(next));
      continue;
    }
    same->place.is_recognised |= next.place.is_recognised;
    // until this view they were two places, and one of them explained earlier views badly
    next.evidence.back() = same->evidence.back();
    if (same->num_inliers() < next.num_inliers()) same->evidence = std::move(next.evidence);
  }
  hypotheses_ = std::move(distinct);
  std::erase_if(hypotheses_,
                [](const Hypothesis& hypothesis) { return hypothesis.num_inliers() == 0; });
  std::stable_sort(
      hypotheses_.begin(), hypotheses_.end(),
      [](const Hypothesis& a, const Hypothesis& b) { return a.num_inliers() > b.num_inliers(); });
  if (hypotheses_.size() > kMaxHypotheses) hypotheses_.resize(kMaxHypotheses);
}

void PoseHypotheses::add_evidence(const Query& query) {
  int most_visible = 0;
  for (Hypothesis& hypothesis : hypotheses_) {
    hypothesis.evidence.push_back(measure_view(query.view, query.map, hypothesis.place,
                                               hypothesis.pose ? &*hypothesis.pose : nullptr,
                                               map_config_));
    if (hypothesis.pose)
      most_visible = std::max(most_visible, hypothesis.evidence.back().total.num_visible);
    if (hypothesis.evidence.size() > kRememberedViews)
      hypothesis.evidence.erase(hypothesis.evidence.begin());
  }
  for (Hypothesis& hypothesis : hypotheses_) {
    ViewEvidence& now = hypothesis.evidence.back();
    now.is_comparable =
        now.total.num_visible > 0 && now.total.num_visible >= kMinVisibleRatio * most_visible;
  }
}

bool PoseHypotheses::has_untracked_recognition(const std::vector<Place>& candidates,
                                               const Query& query) const {
  return std::ranges::any_of(candidates, [&](const Place& place) {
    if (!is_recognized_and_reachable(place, query.view, query.is_reachable)) return false;
    return std::ranges::none_of(hypotheses_, [&](const Hypothesis& hypothesis) {
      return hypothesis.pose &&
             are_one_place(query.map, hypothesis.place, place, median_distance(*hypothesis.pose));
    });
  });
}

bool is_competing(const std::vector<ViewEvidence>& other, const std::vector<ViewEvidence>& views,
                  const CompetingLimits& limits) {
  const ComparedCounts sums = compare(other, views);
  if (sums.b.num_inliers < kMinComparedRatio * sums.b_in_all.num_inliers) return true;
  const bool has_as_many_inliers = sums.a.num_inliers > limits.max_ratio * sums.b.num_inliers;
  const bool is_weak = sums.a_in_all.num_inliers < limits.weak_inliers * sums.num_views;
  const bool has_as_many_per_landmark = 1.0 * sums.a.num_inliers * sums.b.num_visible >
                                        limits.max_ratio * sums.b.num_inliers * sums.a.num_visible;
  return has_as_many_inliers || (!is_weak && has_as_many_per_landmark);
}

bool PoseHypotheses::is_accepted(const Hypothesis& hypothesis,
                                 const RequiredEvidence& required) const {
  if (!hypothesis.pose || !hypothesis.place.is_recognised) return false;
  const bool is_weak = hypothesis.pose->track.pose.status == core::FrameStatus::kWeak;
  if (is_weak && !(required.may_be_weak && hypotheses_.size() == 1)) return false;
  const auto num_comparable =
      std::count_if(hypothesis.evidence.begin(), hypothesis.evidence.end(),
                    [](const ViewEvidence& of_view) { return of_view.is_comparable; });
  if (num_comparable < required.num_views) return false;
  const CompetingLimits limits{track_config_.relocalization.max_competing_ratio,
                               track_config_.weak_inliers};
  return std::none_of(hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& other) {
    return &other != &hypothesis && is_competing(other.evidence, hypothesis.evidence, limits);
  });
}

bool PoseHypotheses::has_recent(int num_views) const {
  return std::any_of(hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& hypothesis) {
    return hypothesis.place.is_recognised && std::ssize(hypothesis.evidence) < num_views;
  });
}

std::optional<RelocalizedPose> PoseHypotheses::evaluate(const features::View& view,
                                                        const scene::MapVersion& map,
                                                        const std::vector<Place>& candidates,
                                                        const RequiredEvidence& required,
                                                        const IsReachable& is_reachable) {
  const Query query{view, map, is_reachable};
  update_all(query, candidates);
  if (hypotheses_.empty() || has_untracked_recognition(candidates, query)) return std::nullopt;
  for (Hypothesis& hypothesis : hypotheses_) {
    if (!is_accepted(hypothesis, required)) continue;
    if (required.is_predicted && !is_predicted_alone(hypothesis, required.is_predicted)) continue;
    RelocalizedPose accepted = std::move(*hypothesis.pose);
    reset();
    return accepted;
  }
  return std::nullopt;
}

void PoseHypotheses::update_all(const Query& query, const std::vector<Place>& candidates) {
  std::vector<Place> elsewhere;
  for (Hypothesis& known : hypotheses_) update(known, query, elsewhere);
  for (const Place& place : candidates) add(place, query);
  for (const Place& place : elsewhere) add(place, query);
  if (hypotheses_.empty()) return;
  add_evidence(query);
  merge_equal(query.map);
}

bool PoseHypotheses::is_predicted_alone(const Hypothesis& hypothesis,
                                        const IsReachable& is_predicted) const {
  return std::ranges::all_of(hypotheses_, [&](const Hypothesis& other) {
    return (&other == &hypothesis) == (other.pose && is_predicted(other.pose->track.pose));
  });
}

std::optional<LeadingHypotheses> PoseHypotheses::take_leading(int num_views) {
  const auto leads = [num_views](const Hypothesis& hypothesis) {
    return hypothesis.pose && hypothesis.place.is_recognised &&
           hypothesis.pose->track.pose.status != core::FrameStatus::kWeak &&
           std::ssize(hypothesis.evidence) >= num_views;
  };
  const auto best = std::find_if(hypotheses_.begin(), hypotheses_.end(), leads);
  if (best == hypotheses_.end()) return std::nullopt;
  LeadingHypotheses leading{std::move(*best->pose), {}};
  for (auto other = hypotheses_.begin(); other != hypotheses_.end(); ++other)
    if (other != best) leading.others.push_back(other->place);
  reset();
  return leading;
}

}  // namespace samewhere::pipeline
