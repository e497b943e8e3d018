#include <algorithm>
#include <utility>

#include <samewhere/core/median.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/pipeline/place_finder.hpp>

namespace samewhere::pipeline {
namespace {

// Of the distance to what is in sight. A map whose loops are open shows one place twice, some
// drift apart.
constexpr double kOnePlaceRatio = 0.25;
constexpr double kOnePlace_rad = 0.35;
// Views that count: older ones would hold up who has walked out of a look-alike.
constexpr std::size_t kRememberedViews = 10;
constexpr std::size_t kMaxHypotheses = 8;
// From so many times the distance, or from this part of it, a landmark looks as it was described.
constexpr double kSameLook = 1.3;
// Of the landmarks that should be in sight at the place that shows most.
constexpr double kMinTestable = 0.5;
constexpr double kMargin_px = 8.0;  // of the image: no feature is found closer to its border

bool is_inside(const Eigen::Vector2d& pixel, const cv::Size& size_px) {
  return pixel.x() > kMargin_px && pixel.y() > kMargin_px &&
         pixel.x() < size_px.width - kMargin_px && pixel.y() < size_px.height - kMargin_px;
}

core::Rigid3 world_from_body(const scene::MapVersion& map, const Place& place) {
  return scene::world_from_body(map, place.keyframe) *
         place.keyframe_from_body.value_or(core::Rigid3{});
}

// Of what the view shows there, from the camera.
double median_distance(const FoundPlace& found) {
  std::vector<double> distances;
  for (const auto& match : found.track.matches) {
    const Eigen::Vector3d& point =
        found.around.points_in_reference[static_cast<std::size_t>(match.first)];
    distances.push_back((point - found.track.pose.reference_from_frame.translation).norm());
  }
  return core::median(std::move(distances)).value_or(0.0);
}

bool are_one_place(const scene::MapVersion& map, const Place& a, const Place& b,
                   double distance_m) {
  const core::Rigid3 apart = inverse(world_from_body(map, a)) * world_from_body(map, b);
  return apart.translation.norm() <= kOnePlaceRatio * distance_m &&
         core::angle_rad(apart.rotation) <= kOnePlace_rad;
}

core::KeyframeId nearest_keyframe(const scene::MapVersion& map, const FoundPlace& found) {
  std::vector<core::LandmarkId> seen;
  for (const auto& match : found.track.matches)
    seen.push_back(found.around.landmarks[static_cast<std::size_t>(match.first)]);
  return keyframe_showing_most(map, seen).value_or(found.around.reference);
}

int num_in_sight(const scene::LocalMap& around, const features::View& view,
                 const core::Rigid3& reference_from_body) {
  const core::Rigid3 camera_from_reference =
      inverse(reference_from_body * view.rig->body_from_camera[0]);
  int count = 0;
  for (int i = 0; i < around.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Eigen::Vector3d point = camera_from_reference * around.points_in_reference[k];
    const double nearer = around.range_m[k] / point.norm();
    const bool looks_as_before = nearer < kSameLook && 1.0 / nearer < kSameLook;
    const auto pixel = geometry::project_undistorted(view.rig->cameras[0], point);
    if (looks_as_before && pixel && is_inside(*pixel, view.image_size_px)) ++count;
  }
  return count;
}

}  // namespace

std::optional<FoundPlace> PlaceFinder::track_around(
    core::KeyframeId keyframe, const features::View& view, const scene::MapVersion& map,
    const std::optional<core::Rigid3>& keyframe_from_body) const {
  FoundPlace found{build_local_map(map, keyframe, config_.map.max_neighbours), {}};
  auto track = tracker_.track_anywhere(view, found.around);
  if (keyframe_from_body) {
    auto near = tracker_.track(view, found.around, *keyframe_from_body);
    if (near && (!track || near->pose.num_inliers > track->pose.num_inliers))
      track = std::move(near);
  }
  if (!track) return std::nullopt;
  found.track = std::move(*track);
  return found;
}

void PlaceFinder::look_at(const Place& place, const features::View& view,
                          const scene::MapVersion& map, const IsWithinReach& is_within_reach,
                          Hypothesis& hypothesis) const {
  hypothesis.found.reset();
  const scene::Holder holder = holder_of(map, place.keyframe);
  std::optional<core::Rigid3> guess = place.keyframe_from_body;
  if (guess) guess = holder.holder_from_keyframe * *guess;
  auto found = track_around(holder.keyframe, view, map, guess);
  if (!found) return;
  const core::KeyframeId nearest = nearest_keyframe(map, *found);
  if (nearest != found->around.reference) {
    auto nearer = track_around(nearest, view, map,
                               inverse(scene::world_from_body(map, nearest)) *
                                   scene::world_from_body(map, found->around.reference) *
                                   found->track.pose.reference_from_frame);
    if (nearer && nearer->track.pose.num_inliers > found->track.pose.num_inliers)
      found = std::move(nearer);
  }
  if (!is_within_reach(found->track.pose)) return;
  hypothesis.place = {found->track.pose.reference_keyframe, found->track.pose.reference_from_frame,
                      place.is_recognised};
  hypothesis.found = std::move(found);
}

PlaceFinder::Explained PlaceFinder::Hypothesis::sum_of_last(std::size_t num_views) const {
  Explained sum;
  for (std::size_t i = explained.size() - num_views; i < explained.size(); ++i) {
    sum.num_inliers += explained[i].num_inliers;
    sum.num_expected += explained[i].num_expected;
  }
  return sum;
}

void PlaceFinder::think_of(const Place& place, const features::View& view,
                           const scene::MapVersion& map, const IsWithinReach& is_within_reach) {
  for (Hypothesis& known : hypotheses_) {
    if (!known.found || !place.keyframe_from_body ||
        !are_one_place(map, known.place, place, median_distance(*known.found)))
      continue;
    known.place.is_recognised |= place.is_recognised;
    return;
  }
  Hypothesis next;
  look_at(place, view, map, is_within_reach, next);
  if (next.found) hypotheses_.push_back(std::move(next));
}

// Each place once, as it explains most.
void PlaceFinder::merge(const scene::MapVersion& map) {
  const auto num_inliers = [](const Hypothesis& hypothesis) {
    return hypothesis.found ? hypothesis.found->track.pose.num_inliers : 0;
  };
  std::stable_sort(
      hypotheses_.begin(), hypotheses_.end(),
      [&](const Hypothesis& a, const Hypothesis& b) { return num_inliers(a) > num_inliers(b); });
  std::vector<Hypothesis> distinct;
  for (Hypothesis& next : hypotheses_) {
    const auto same = std::find_if(distinct.begin(), distinct.end(), [&](const Hypothesis& other) {
      return next.found && other.found &&
             are_one_place(map, other.place, next.place, median_distance(*other.found));
    });
    if (same == distinct.end()) {
      distinct.push_back(std::move(next));
      continue;
    }
    same->place.is_recognised |= next.place.is_recognised;
    if (same->explained.size() < next.explained.size()) same->explained = next.explained;
  }
  hypotheses_ = std::move(distinct);
  std::erase_if(hypotheses_, [](const Hypothesis& hypothesis) {
    return hypothesis.sum_of_last(hypothesis.explained.size()).num_inliers == 0;
  });
  if (hypotheses_.size() > kMaxHypotheses) hypotheses_.resize(kMaxHypotheses);
}

// Who is not found there is judged by where he was a view ago.
PlaceFinder::Explained PlaceFinder::explained(const Hypothesis& hypothesis,
                                              const features::View& view,
                                              const scene::MapVersion& map) const {
  if (hypothesis.found) {
    const auto& [around, track] = *hypothesis.found;
    const int num_inliers = track.pose.num_inliers;
    const int num_expected = num_in_sight(around, view, track.pose.reference_from_frame);
    return {num_inliers, std::max(num_expected, num_inliers)};
  }
  const Place& last = hypothesis.place;
  const scene::Holder holder = holder_of(map, last.keyframe);
  const scene::LocalMap around = build_local_map(map, holder.keyframe, config_.map.max_neighbours);
  return {0, num_in_sight(
                 around, view,
                 holder.holder_from_keyframe * last.keyframe_from_body.value_or(core::Rigid3{}))};
}

// A place whose map ends where the view looks now says nothing about it, for or against.
void PlaceFinder::record(const features::View& view, const scene::MapVersion& map) {
  std::vector<Explained> of_view;
  int most_expected = 0;
  for (const Hypothesis& hypothesis : hypotheses_) {
    of_view.push_back(explained(hypothesis, view, map));
    most_expected = std::max(most_expected, of_view.back().num_expected);
  }
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    auto& history = hypotheses_[i].explained;
    if (!history.empty() && of_view[i].num_expected < kMinTestable * most_expected) continue;
    history.push_back(of_view[i]);
    if (history.size() > kRememberedViews) history.erase(history.begin());
  }
}

// Of as many views as both were asked about.
bool PlaceFinder::is_rival(const Hypothesis& other, const Hypothesis& hypothesis) const {
  const std::size_t num_views = std::min(other.explained.size(), hypothesis.explained.size());
  const Explained by_other = other.sum_of_last(num_views);
  const Explained by_this = hypothesis.sum_of_last(num_views);
  const double ratio = config_.track.max_lost_rival_ratio;
  const auto weak = static_cast<std::size_t>(config_.track.weak_inliers) * num_views;
  const bool explains_as_much = by_other.num_inliers > ratio * by_this.num_inliers;
  const bool is_as_true_to_itself = static_cast<std::size_t>(by_other.num_inliers) >= weak &&
                                    1.0 * by_other.num_inliers * by_this.num_expected >
                                        ratio * by_this.num_inliers * by_other.num_expected;
  return explains_as_much || is_as_true_to_itself;
}

bool PlaceFinder::has_fresh_place(int num_views) const {
  return std::any_of(hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& hypothesis) {
    return hypothesis.place.is_recognised && std::ssize(hypothesis.explained) < num_views;
  });
}

std::optional<FoundPlace> PlaceFinder::look(const features::View& view,
                                            const scene::MapVersion& map,
                                            const std::vector<Place>& places, int num_views,
                                            const IsWithinReach& is_within_reach) {
  for (Hypothesis& known : hypotheses_) look_at(known.place, view, map, is_within_reach, known);
  for (const Place& place : places) think_of(place, view, map, is_within_reach);
  record(view, map);
  merge(map);
  for (Hypothesis& hypothesis : hypotheses_) {
    const bool is_seen = hypothesis.found && hypothesis.place.is_recognised &&
                         hypothesis.found->track.pose.status != core::FrameStatus::kWeak;
    const bool has_rival =
        std::any_of(hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& other) {
          return &other != &hypothesis && is_rival(other, hypothesis);
        });
    if (!is_seen || std::ssize(hypothesis.explained) < num_views || has_rival) continue;
    FoundPlace found = std::move(*hypothesis.found);
    forget();
    return found;
  }
  return std::nullopt;
}

}  // namespace samewhere::pipeline
