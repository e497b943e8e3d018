#include <algorithm>
#include <utility>

#include <samewhere/core/median.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/map/mapper.hpp>
#include <samewhere/pipeline/pose_hypotheses.hpp>

namespace samewhere::pipeline {
namespace {

// Of the distance to what is in sight. A map whose loops are open shows one place twice, some
// drift apart.
constexpr double kOnePlaceRatio = 0.25;
constexpr double kOnePlace_rad = 0.35;
// Views that count. Fewer would forget a place while the view looks beyond the end of its map; more
// would hold up who has walked out of a look-alike.
constexpr std::size_t kRememberedViews = 30;
constexpr std::size_t kMaxHypotheses = 8;
// From so many times the distance, or from this part of it, a landmark looks as it was described.
constexpr double kSameLook = 1.3;
// Of the landmarks that should be in sight at the place that shows most, in a view or a cell of it:
// with fewer, the map ends there.
constexpr double kMinTestable = 0.5;
// Of what a place explains: if less of it lies where the map shows another place, too, nobody can
// tell the two apart.
constexpr double kMinShared = 0.25;
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

int num_inliers(const FoundPlace& found) { return found.track.pose.num_inliers; }

Place place_of(const FoundPlace& found) {
  return {found.track.pose.reference_keyframe, found.track.pose.reference_from_frame, false};
}

// By the judge, who also says where there.
bool is_recognised_within_reach(const Place& place, const features::View& view,
                                const IsWithinReach& is_within_reach) {
  if (!place.is_recognised || !place.keyframe_from_body) return false;
  core::FramePose pose;
  pose.frame = view.frame;
  pose.stamp_s = view.stamp_s;
  pose.reference_keyframe = place.keyframe;
  pose.reference_from_frame = *place.keyframe_from_body;
  return is_within_reach(pose);
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

// Of columns * rows.
std::size_t cell_of(const Eigen::Vector2d& pixel, const cv::Size& size_px, int columns, int rows) {
  const auto part = [](double at_px, int end_px, int parts) {
    return static_cast<int>(std::clamp(at_px / end_px * parts, 0.0, parts - 1.0));
  };
  const int row = part(pixel.y(), size_px.height, rows);
  return static_cast<std::size_t>(row * columns + part(pixel.x(), size_px.width, columns));
}

// Calls visit(pixel) for each landmark that should be in sight.
template <typename Visit>
void for_each_in_sight(const scene::LocalMap& around, const features::View& view,
                       const core::Rigid3& reference_from_body, const Visit& visit) {
  const core::Rigid3 camera_from_reference =
      inverse(reference_from_body * view.rig->body_from_camera[0]);
  for (int i = 0; i < around.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Eigen::Vector3d point = camera_from_reference * around.points_in_reference[k];
    const double nearer = around.range_m[k] / point.norm();
    const bool looks_as_before = nearer < kSameLook && 1.0 / nearer < kSameLook;
    const auto pixel = geometry::project_undistorted(view.rig->cameras[0], point);
    if (looks_as_before && pixel && is_inside(*pixel, view.image_size_px)) visit(*pixel);
  }
}

}  // namespace

void PlaceFinder::track_around(core::KeyframeId keyframe, const Place& place,
                               const Question& question, Sight& sight) const {
  const scene::MapVersion& map = question.map;
  const scene::LocalMap around = map::local_map(map, keyframe, config_.map);
  const auto offer = [&](std::optional<track::Track> track) {
    if (!track || !question.is_within_reach(track->pose)) return;
    FoundPlace next{around, std::move(*track)};
    const bool is_there = !place.keyframe_from_body ||
                          are_one_place(map, place, place_of(next), median_distance(next));
    auto& best = is_there ? sight.found : sight.elsewhere;
    if (!best || num_inliers(next) > num_inliers(*best)) best = std::move(next);
  };
  if (place.keyframe_from_body) {
    const core::Rigid3 guess =
        inverse(scene::world_from_body(map, keyframe)) * world_from_body(map, place);
    offer(tracker_.track(question.view, around, guess));
  }
  offer(tracker_.track_anywhere(question.view, around));
}

PlaceFinder::Sight PlaceFinder::look_at(const Place& place, const Question& question) const {
  const scene::MapVersion& map = question.map;
  Sight sight;
  const core::KeyframeId first = holder_of(map, place.keyframe).keyframe;
  track_around(first, place, question, sight);
  if (!sight.found) return sight;
  const core::KeyframeId nearest = nearest_keyframe(map, *sight.found);
  if (nearest != first) track_around(nearest, place_of(*sight.found), question, sight);
  return sight;
}

void PlaceFinder::think_of(const Place& place, const Question& question) {
  for (Hypothesis& known : hypotheses_) {
    if (!known.found ||
        !are_one_place(question.map, known.place, place, median_distance(*known.found)))
      continue;
    known.place.is_recognised |= place.is_recognised;
    return;
  }
  Sight sight = look_at(place, question);
  if (!sight.found) return;
  Hypothesis next{place_of(*sight.found), {}, std::move(sight.found)};
  next.place.is_recognised = place.is_recognised;
  hypotheses_.push_back(std::move(next));
}

int PlaceFinder::Hypothesis::num_inliers() const {
  int count = 0;
  for (const Explained& of_view : explained)
    count += of_view.is_testable ? of_view.all.num_inliers : 0;
  return count;
}

// Each place once, as it explains most.
void PlaceFinder::merge(const scene::MapVersion& map) {
  std::stable_sort(hypotheses_.begin(), hypotheses_.end(),
                   [](const Hypothesis& a, const Hypothesis& b) {
                     return a.explained.back().all.num_inliers > b.explained.back().all.num_inliers;
                   });
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
    // what was another place until now made little of the views before
    next.explained.back() = same->explained.back();
    if (same->num_inliers() < next.num_inliers()) same->explained = std::move(next.explained);
  }
  hypotheses_ = std::move(distinct);
  std::erase_if(hypotheses_,
                [](const Hypothesis& hypothesis) { return hypothesis.num_inliers() == 0; });
  std::stable_sort(
      hypotheses_.begin(), hypotheses_.end(),
      [](const Hypothesis& a, const Hypothesis& b) { return a.num_inliers() > b.num_inliers(); });
  if (hypotheses_.size() > kMaxHypotheses) hypotheses_.resize(kMaxHypotheses);
}

// Who is not found there is judged by where he was last found.
PlaceFinder::Explained PlaceFinder::explained(const Hypothesis& hypothesis,
                                              const features::View& view,
                                              const scene::MapVersion& map) const {
  Explained of_view;
  const auto at = [&](const Eigen::Vector2d& pixel) -> Evidence& {
    return of_view.cells[cell_of(pixel, view.image_size_px, kColumns, kRows)];
  };
  const auto expect = [&](const scene::LocalMap& around, const core::Rigid3& reference_from_body) {
    for_each_in_sight(around, view, reference_from_body,
                      [&](const Eigen::Vector2d& pixel) { ++at(pixel).num_expected; });
  };
  if (hypothesis.found) {
    const auto& [around, track] = *hypothesis.found;
    expect(around, track.pose.reference_from_frame);
    for (const features::Match& match : track.matches) {
      const auto feature = static_cast<std::size_t>(match.second);
      ++at(view.features->undistorted_px[feature].cast<double>()).num_inliers;
    }
  } else {
    const Place& last = hypothesis.place;
    const core::KeyframeId keyframe = holder_of(map, last.keyframe).keyframe;
    expect(map::local_map(map, keyframe, config_.map),
           inverse(scene::world_from_body(map, keyframe)) * world_from_body(map, last));
  }
  // an inlier may be seen from nearer or closer to the border than is expected
  for (Evidence& of_cell : of_view.cells) {
    of_cell.num_expected = std::max(of_cell.num_expected, of_cell.num_inliers);
    of_view.all += of_cell;
  }
  return of_view;
}

void PlaceFinder::record(const features::View& view, const scene::MapVersion& map) {
  int most_expected = 0;
  for (Hypothesis& hypothesis : hypotheses_) {
    hypothesis.explained.push_back(explained(hypothesis, view, map));
    if (hypothesis.found)
      most_expected = std::max(most_expected, hypothesis.explained.back().all.num_expected);
    if (hypothesis.explained.size() > kRememberedViews)
      hypothesis.explained.erase(hypothesis.explained.begin());
  }
  for (Hypothesis& hypothesis : hypotheses_) {
    Explained& now = hypothesis.explained.back();
    now.is_testable =
        now.all.num_expected > 0 && now.all.num_expected >= kMinTestable * most_expected;
  }
}

bool PlaceFinder::has_unheard(const std::vector<Place>& places, const Question& question) const {
  return std::ranges::any_of(places, [&](const Place& place) {
    if (!is_recognised_within_reach(place, question.view, question.is_within_reach)) return false;
    return std::ranges::none_of(hypotheses_, [&](const Hypothesis& hypothesis) {
      return hypothesis.found && are_one_place(question.map, hypothesis.place, place,
                                               median_distance(*hypothesis.found));
    });
  });
}

bool PlaceFinder::are_comparable(const Evidence& a, const Evidence& b) {
  return std::min(a.num_expected, b.num_expected) >=
         kMinTestable * std::max(a.num_expected, b.num_expected);
}

bool PlaceFinder::is_rival(const Hypothesis& other, const Hypothesis& hypothesis) const {
  Evidence by_other;  // where both may speak
  Evidence by_this;
  Evidence by_other_in_all;
  Evidence by_this_in_all;
  int num_views = 0;
  auto a = other.explained.rbegin();
  for (auto b = hypothesis.explained.rbegin();
       a != other.explained.rend() && b != hypothesis.explained.rend(); ++a, ++b) {
    if (!a->is_testable || !b->is_testable) continue;
    ++num_views;
    by_other_in_all += a->all;
    by_this_in_all += b->all;
    for (std::size_t i = 0; i < a->cells.size(); ++i) {
      if (!are_comparable(a->cells[i], b->cells[i])) continue;
      by_other += a->cells[i];
      by_this += b->cells[i];
    }
  }
  if (by_this.num_inliers < kMinShared * by_this_in_all.num_inliers) return true;
  const double ratio = config_.track.lost.max_rival_ratio;
  const bool explains_as_much = by_other.num_inliers > ratio * by_this.num_inliers;
  const bool is_weak = by_other_in_all.num_inliers < config_.track.weak_inliers * num_views;
  const bool is_as_true_to_itself = 1.0 * by_other.num_inliers * by_this.num_expected >
                                    ratio * by_this.num_inliers * by_other.num_expected;
  return explains_as_much || (!is_weak && is_as_true_to_itself);
}

bool PlaceFinder::is_proven(const Hypothesis& hypothesis, const Proof& proof) const {
  if (!hypothesis.found || !hypothesis.place.is_recognised) return false;
  const bool is_weak = hypothesis.found->track.pose.status == core::FrameStatus::kWeak;
  if (is_weak && !(proof.may_be_weak && hypotheses_.size() == 1)) return false;
  const auto num_testable =
      std::count_if(hypothesis.explained.begin(), hypothesis.explained.end(),
                    [](const Explained& of_view) { return of_view.is_testable; });
  if (num_testable < proof.num_views) return false;
  return std::none_of(hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& other) {
    return &other != &hypothesis && is_rival(other, hypothesis);
  });
}

bool PlaceFinder::has_fresh_place(int num_views) const {
  return std::any_of(hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& hypothesis) {
    return hypothesis.place.is_recognised && std::ssize(hypothesis.explained) < num_views;
  });
}

std::optional<FoundPlace> PlaceFinder::look(const features::View& view,
                                            const scene::MapVersion& map,
                                            const std::vector<Place>& places, const Proof& proof,
                                            const IsWithinReach& is_within_reach) {
  const Question question{view, map, is_within_reach};
  std::vector<Place> elsewhere;
  for (Hypothesis& known : hypotheses_) {
    Sight sight = look_at(known.place, question);
    known.found = std::move(sight.found);
    if (known.found) {
      const bool is_recognised = known.place.is_recognised;
      known.place = place_of(*known.found);
      known.place.is_recognised = is_recognised;
    }
    if (sight.elsewhere) elsewhere.push_back(place_of(*sight.elsewhere));
  }
  for (const Place& place : places) think_of(place, question);
  for (const Place& place : elsewhere) think_of(place, question);
  if (hypotheses_.empty()) return std::nullopt;
  record(view, map);
  merge(map);
  if (has_unheard(places, question)) return std::nullopt;
  for (Hypothesis& hypothesis : hypotheses_) {
    if (!is_proven(hypothesis, proof)) continue;
    FoundPlace found = std::move(*hypothesis.found);
    forget();
    return found;
  }
  return std::nullopt;
}

}  // namespace samewhere::pipeline
