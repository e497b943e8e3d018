#include <algorithm>
#include <utility>

#include <samewhere/map/mapper.hpp>
#include <samewhere/pipeline/motion_prediction.hpp>
#include <samewhere/pipeline/place_hypothesis.hpp>
#include <samewhere/pipeline/pose_hypotheses.hpp>

namespace samewhere::pipeline {
namespace {

constexpr std::size_t kMaxViews = 30;
constexpr int kMinVisible = 30;       // landmarks; with fewer the map ends
constexpr int kMinViewsOfOthers = 4;  // the first ones may be of a poor pose
constexpr double kMaxOtherRatio = 0.85;

std::vector<core::LandmarkId> inliers_of(const RelocalizedPose& pose) {
  std::vector<core::LandmarkId> ids;
  for (const auto& match : pose.track.matches)
    ids.push_back(pose.local_map.landmarks[static_cast<std::size_t>(match.first)]);
  return ids;
}

// Metres since the last step where the camera had not been yet.
double new_metres(PlaceHypothesis& hypothesis, const scene::MapVersion& map) {
  const double metre = metre_of(map);
  return hypothesis.new_ground.add(world_from_body(map, hypothesis.place).translation / metre,
                                   hypothesis.since_step.translation.norm() / metre);
}

}  // namespace

double FoundRatios::at(const scene::LocalMap& local_map, const scene::MapVersion& map) {
  constexpr double kUsual = 0.5;
  if (std::exchange(map_number_, map.number) != map.number) known_.clear();
  const auto [known, is_new] = known_.try_emplace(local_map.reference, kUsual);
  if (is_new) known->second = found_ratio_of_mapping(map, local_map).value_or(kUsual);
  return known->second;
}

bool PlaceHypothesis::is_in_map() const {
  return !views.empty() && views.back().total.num_visible >= kMinVisible;
}

void PlaceHypothesis::add_view(const features::View& view, const scene::MapVersion& map,
                               const map::Config& config) {
  if (!views.empty() && views.back().frame == view.frame) return;
  ViewEvidence of_view = measure_view(view, map, place, pose ? &*pose : nullptr, config);
  of_view.is_comparable = of_view.total.num_visible >= kMinVisible;
  views.push_back(of_view);
  if (views.size() > kMaxViews) views.erase(views.begin());
}

void PlaceHypothesis::add_step(const features::View& view, const scene::MapVersion& map,
                               const map::Config& config, FoundRatios& of_mapping) {
  add_view(view, map, config);
  const Counts& total = views.back().total;
  PlaceView of_place{.found_ratio = 0.0, .new_ratio = 1.0, .moved_m = new_metres(*this, map)};
  if (pose) {
    const std::vector<core::LandmarkId> inliers = inliers_of(*pose);
    int num_new = 0;
    for (const core::LandmarkId id : inliers) num_new += seen.insert(id).second ? 1 : 0;
    of_place.new_ratio = static_cast<double>(num_new) / static_cast<double>(inliers.size());
    of_place.found_ratio =
        total.num_inliers / (of_mapping.at(pose->local_map, map) * std::max(1, total.num_visible));
  }
  if (is_in_map()) evidence.add(of_place);
  num_failures = pose ? 0 : num_failures + 1;
  since_step = {};
  since_step_m = 0.0;
}

double log_ratio(const PlaceHypothesis& hypothesis, const std::vector<PlaceHypothesis>& all,
                 int weak_inliers) {
  double by_lookalike = 0.0;
  double by_too_few = 0.0;  // inliers for this place: it may be a look-alike that is not in the map
  double against = 0.0;     // objects that a look-alike alone explains
  for (const PlaceHypothesis& other : all) {
    if (&other == &hypothesis || !other.place.is_recognised) continue;
    const ComparedCounts sums = compare(other.views, hypothesis.views);
    if (sums.num_views < kMinViewsOfOthers || sums.b.num_inliers == 0) continue;
    if (sums.a_in_all.num_inliers < weak_inliers * sums.num_views) continue;
    const double in_all = 1.0 * sums.a_in_all.num_inliers / sums.b_in_all.num_inliers;
    const double in_comparable = 1.0 * sums.a.num_inliers / sums.b.num_inliers;
    if (is_lookalike(std::min(in_all, in_comparable), sums.num_views)) {
      const double by_found = log_ratio_by_lookalike(
          hypothesis.evidence.found_ratio(), in_comparable, hypothesis.evidence.num_independent());
      by_lookalike = std::max(by_lookalike, by_found);
      by_too_few = std::min(by_too_few, by_found);
    }
    const double by_differences = log_ratio_by_differences(other.differences);
    by_lookalike = std::max(by_lookalike, by_differences);
    against = std::min(against, by_differences);
  }
  // objects of this place alone confirm it no more where too little else of it is found; that alone
  // does not take it back, it may have changed
  return hypothesis.evidence.log_likelihood_ratio() + hypothesis.log_ratio_by_motion +
         std::max(0.0, by_lookalike + by_too_few) + against;
}

bool is_alone(const PlaceHypothesis& hypothesis, const std::vector<PlaceHypothesis>& all,
              int weak_inliers) {
  // the likelihood ratio says how much less is less enough
  const CompetingLimits limits{kMaxOtherRatio, weak_inliers};
  return std::ranges::none_of(all, [&](const PlaceHypothesis& other) {
    if (&other == &hypothesis) return false;
    if (other.place.is_recognised && std::ssize(other.views) < kMinViewsOfOthers) return true;
    if (other.differences.is_here()) return false;
    return !other.views.empty() && is_competing(other.views, hypothesis.views, limits);
  });
}

}  // namespace samewhere::pipeline
