#include <algorithm>
#include <utility>

#include <samewhere/core/median.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/map/mapper.hpp>
#include <samewhere/pipeline/pose_hypotheses.hpp>

namespace samewhere::pipeline {
namespace {

// Of the distance to the visible landmarks. In a map with open loops one place exists twice, apart
// by the accumulated drift.
constexpr double kOnePlaceRatio = 0.25;
constexpr double kOnePlace_rad = 0.35;
// Fewer would lose a place while the camera looks beyond the end of its map; more would delay
// relocalization after the camera has left a look-alike place.
constexpr std::size_t kRememberedViews = 30;
constexpr std::size_t kMaxHypotheses = 8;
// Change of distance, by this factor, at which a landmark still looks as it was described.
constexpr double kMaxDistanceRatio = 1.3;
// Of the visible landmarks of the hypothesis with most, in a view or a cell of it: with fewer, the
// map ends there.
constexpr double kMinVisibleRatio = 0.5;
// Of the inliers of a hypothesis: if fewer lie in comparable cells, the two are undecided.
constexpr double kMinComparedRatio = 0.25;
constexpr double kMargin_px = 8.0;  // no feature is detected closer to the image border

bool is_inside(const Eigen::Vector2d& pixel, const cv::Size& size_px) {
  return pixel.x() > kMargin_px && pixel.y() > kMargin_px &&
         pixel.x() < size_px.width - kMargin_px && pixel.y() < size_px.height - kMargin_px;
}

core::Rigid3 world_from_body(const scene::MapVersion& map, const Place& place) {
  return scene::world_from_body(map, place.keyframe) *
         place.keyframe_from_body.value_or(core::Rigid3{});
}

// Of the inlier landmarks, from the camera.
double median_distance(const RelocalizedPose& pose) {
  std::vector<double> distances;
  for (const auto& match : pose.track.matches) {
    const Eigen::Vector3d& point =
        pose.local_map.points_in_reference[static_cast<std::size_t>(match.first)];
    distances.push_back((point - pose.track.pose.reference_from_frame.translation).norm());
  }
  return core::median(std::move(distances)).value_or(0.0);
}

int num_inliers(const RelocalizedPose& pose) { return pose.track.pose.num_inliers; }

Place place_of(const RelocalizedPose& pose) {
  return {pose.track.pose.reference_keyframe, pose.track.pose.reference_from_frame, false};
}

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

bool are_one_place(const scene::MapVersion& map, const Place& a, const Place& b,
                   double distance_m) {
  const core::Rigid3 apart = inverse(world_from_body(map, a)) * world_from_body(map, b);
  return apart.translation.norm() <= kOnePlaceRatio * distance_m &&
         core::angle_rad(apart.rotation) <= kOnePlace_rad;
}

core::KeyframeId nearest_keyframe(const scene::MapVersion& map, const RelocalizedPose& pose) {
  std::vector<core::LandmarkId> seen;
  for (const auto& match : pose.track.matches)
    seen.push_back(pose.local_map.landmarks[static_cast<std::size_t>(match.first)]);
  return keyframe_showing_most(map, seen).value_or(pose.local_map.reference);
}

// Of columns * rows.
std::size_t cell_of(const Eigen::Vector2d& pixel, const cv::Size& size_px, int columns, int rows) {
  const auto part = [](double at_px, int end_px, int parts) {
    return static_cast<int>(std::clamp(at_px / end_px * parts, 0.0, parts - 1.0));
  };
  const int row = part(pixel.y(), size_px.height, rows);
  return static_cast<std::size_t>(row * columns + part(pixel.x(), size_px.width, columns));
}

// Calls visit(pixel) for each visible landmark.
template <typename Visit>
void for_each_visible(const scene::LocalMap& local_map, const features::View& view,
                      const core::Rigid3& reference_from_body, const Visit& visit) {
  const core::Rigid3 camera_from_reference =
      inverse(reference_from_body * view.rig->body_from_camera[0]);
  for (int i = 0; i < local_map.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Eigen::Vector3d point = camera_from_reference * local_map.points_in_reference[k];
    const double nearer = local_map.range_m[k] / point.norm();
    const bool looks_as_described = nearer < kMaxDistanceRatio && 1.0 / nearer < kMaxDistanceRatio;
    const auto pixel = geometry::project_undistorted(view.rig->cameras[0], point);
    if (looks_as_described && pixel && is_inside(*pixel, view.image_size_px)) visit(*pixel);
  }
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

// Without a pose of this view, visible landmarks are counted at the last pose.
PoseHypotheses::ViewEvidence PoseHypotheses::measure(const Hypothesis& hypothesis,
                                                     const Query& query) const {
  const features::View& view = query.view;
  ViewEvidence of_view;
  const auto at = [&](const Eigen::Vector2d& pixel) -> Counts& {
    return of_view.cells[cell_of(pixel, view.image_size_px, kColumns, kRows)];
  };
  const auto count_visible = [&](const scene::LocalMap& local_map,
                                 const core::Rigid3& reference_from_body) {
    for_each_visible(local_map, view, reference_from_body,
                     [&](const Eigen::Vector2d& pixel) { ++at(pixel).num_visible; });
  };
  if (hypothesis.pose) {
    const auto& [local_map, track] = *hypothesis.pose;
    count_visible(local_map, track.pose.reference_from_frame);
    for (const features::Match& match : track.matches) {
      const auto feature = static_cast<std::size_t>(match.second);
      ++at(view.features->undistorted_px[feature].cast<double>()).num_inliers;
    }
  } else {
    const Place& last = hypothesis.place;
    const core::KeyframeId keyframe = holder_of(query.map, last.keyframe).keyframe;
    count_visible(
        map::local_map(query.map, keyframe, map_config_),
        inverse(scene::world_from_body(query.map, keyframe)) * world_from_body(query.map, last));
  }
  // an inlier may be nearer, or closer to the border, than a landmark that counts as visible
  for (Counts& of_cell : of_view.cells) {
    of_cell.num_visible = std::max(of_cell.num_visible, of_cell.num_inliers);
    of_view.total += of_cell;
  }
  return of_view;
}

void PoseHypotheses::add_evidence(const Query& query) {
  int most_visible = 0;
  for (Hypothesis& hypothesis : hypotheses_) {
    hypothesis.evidence.push_back(measure(hypothesis, query));
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

bool PoseHypotheses::are_comparable(const Counts& a, const Counts& b) {
  return std::min(a.num_visible, b.num_visible) >=
         kMinVisibleRatio * std::max(a.num_visible, b.num_visible);
}

bool PoseHypotheses::is_competing(const Hypothesis& other, const Hypothesis& hypothesis) const {
  Counts of_other;  // in comparable cells
  Counts of_this;
  Counts of_other_in_all;
  Counts of_this_in_all;
  int num_views = 0;
  auto a = other.evidence.rbegin();
  for (auto b = hypothesis.evidence.rbegin();
       a != other.evidence.rend() && b != hypothesis.evidence.rend(); ++a, ++b) {
    if (!a->is_comparable || !b->is_comparable) continue;
    ++num_views;
    of_other_in_all += a->total;
    of_this_in_all += b->total;
    for (std::size_t i = 0; i < a->cells.size(); ++i) {
      if (!are_comparable(a->cells[i], b->cells[i])) continue;
      of_other += a->cells[i];
      of_this += b->cells[i];
    }
  }
  if (of_this.num_inliers < kMinComparedRatio * of_this_in_all.num_inliers) return true;
  const double ratio = track_config_.relocalization.max_competing_ratio;
  const bool has_as_many_inliers = of_other.num_inliers > ratio * of_this.num_inliers;
  const bool is_weak = of_other_in_all.num_inliers < track_config_.weak_inliers * num_views;
  const bool has_as_many_per_landmark = 1.0 * of_other.num_inliers * of_this.num_visible >
                                        ratio * of_this.num_inliers * of_other.num_visible;
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
  return std::none_of(hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& other) {
    return &other != &hypothesis && is_competing(other, hypothesis);
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
  std::vector<Place> elsewhere;
  for (Hypothesis& known : hypotheses_) update(known, query, elsewhere);
  for (const Place& place : candidates) add(place, query);
  for (const Place& place : elsewhere) add(place, query);
  if (hypotheses_.empty()) return std::nullopt;
  add_evidence(query);
  merge_equal(map);
  if (has_untracked_recognition(candidates, query)) return std::nullopt;
  for (Hypothesis& hypothesis : hypotheses_) {
    if (!is_accepted(hypothesis, required)) continue;
    RelocalizedPose accepted = std::move(*hypothesis.pose);
    reset();
    return accepted;
  }
  return std::nullopt;
}

}  // namespace samewhere::pipeline
