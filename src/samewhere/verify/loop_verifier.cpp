#include <algorithm>
#include <utility>

#include <samewhere/verify/loop_verifier.hpp>

namespace samewhere::verify {
namespace {

// Of the other recognized candidates the one at another place with most inliers.
std::optional<core::CompetingPlaceEvidence> competing_place_of(
    const core::LedgerRow& row, const std::vector<core::LedgerRow>& rows, const MapContext& map) {
  std::optional<core::CompetingPlaceEvidence> best;
  for (const core::LedgerRow& other : rows) {
    if (!is_recognized(other.verdict) || other.candidate.id == row.candidate.id) continue;
    auto found = map.measure_competing_place(row, other);
    if (!found) continue;
    found->num_inliers = core::evidence_of(other.verdict).geometry->num_inliers;
    if (!best || found->num_inliers > best->num_inliers) best = found;
  }
  return best;
}

// Without the geometry that was measured for a replay alone.
core::Evidence evidence_for_rank(const core::Verdict& verdict) {
  core::Evidence evidence = core::evidence_of(verdict);
  const auto* rejected = std::get_if<core::Rejection>(&verdict);
  if (rejected != nullptr &&
      (rejected->stage == core::Refusal::kSimilarity || rejected->stage == core::Refusal::kPause))
    evidence.geometry.reset();
  return evidence;
}

// Accepted ones first, then by verify::rank.
std::pair<bool, double> order_of(const core::LedgerRow& row, const Config& config) {
  return {core::is_loop(row.verdict), rank(evidence_for_rank(row.verdict), config)};
}

int num_inliers(const core::LedgerRow& row) {
  const auto& geometry = core::evidence_of(row.verdict).geometry;
  return geometry ? geometry->num_inliers : 0;
}

// Of the loops; 0 without any, or where inliers do not rank.
double inliers_to_compete(const std::vector<core::LedgerRow>& rows, const Config& config) {
  int most = 0;
  for (const core::LedgerRow& row : rows)
    if (core::is_loop(row.verdict)) most = std::max(most, num_inliers(row));
  return config.rank_by == RankBy::kInliers ? config.max_competing_place_ratio * most : 0.0;
}

}  // namespace

core::Evidence LoopVerifier::measure(const core::Candidate& candidate, const features::View& query,
                                     const features::View& match, const MapContext& map,
                                     const History& history) const {
  core::Evidence evidence{.similarity = candidate.similarity};
  if (!config().measure_all && refuse_early(candidate, evidence, history, config()))
    return evidence;
  evidence.geometry = measure_geometry(candidate, query, match, map);
  if (!evidence.geometry->match_from_query) return evidence;
  return measured_again(candidate, std::move(evidence), map);
}

core::Evidence LoopVerifier::measured_again(const core::Candidate& candidate,
                                            core::Evidence evidence, const MapContext& map) const {
  const core::Sim3& match_from_query = *evidence.geometry->match_from_query;
  evidence.odometry = map.measure_odometry(candidate, match_from_query);
  evidence.deformation.reset();
  if (config().method == Method::kDeformation && has_geometry(evidence, config()))
    evidence.deformation = map.measure_deformation(candidate, match_from_query);
  evidence.competing_loop.reset();
  if (evidence.odometry)
    evidence.competing_loop = map.measure_competing_loop(candidate, match_from_query);
  return evidence;
}

core::GeometryEvidence LoopVerifier::measure_geometry(const core::Candidate& candidate,
                                                      const features::View& query,
                                                      const features::View& match,
                                                      const MapContext& map) const {
  MeasureSettings settings = settings_.measure;
  if (settings_.features_without_depth && !has_depth(query))
    settings.features = *settings_.features_without_depth;
  const auto views = map.views_with_landmark_depths(candidate);
  if (!views) return verify::measure_geometry(candidate, query, match, settings);
  settings.has_one_scale = false;
  return verify::measure_geometry(candidate, views->query, views->match, settings);
}

void LoopVerifier::compare_candidates_of_one_query(const MapContext& map, const History& history,
                                                   std::vector<core::LedgerRow>& rows) const {
  const std::vector<core::LedgerRow> verified = rows;  // each by itself
  for (core::LedgerRow& row : rows) {
    if (!is_recognized(row.verdict)) continue;
    core::Evidence evidence = core::evidence_of(row.verdict);
    evidence.competing_place = competing_place_of(row, verified, map);
    if (evidence.competing_place) row.verdict = decide(row.candidate, evidence, history);
  }
}

const core::LedgerRow* best_of_query(const std::vector<core::LedgerRow>& rows,
                                     const Config& config) {
  const double least = inliers_to_compete(rows, config);
  const core::LedgerRow* best = nullptr;
  for (const core::LedgerRow& row : rows) {
    if (core::is_loop(row.verdict) && num_inliers(row) < least) continue;
    if (best == nullptr || order_of(row, config) > order_of(*best, config)) best = &row;
  }
  return best;
}

}  // namespace samewhere::verify
