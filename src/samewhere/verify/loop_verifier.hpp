#pragma once

#include <optional>
#include <vector>

#include <samewhere/core/ledger.hpp>
#include <samewhere/features/config.hpp>
#include <samewhere/features/features.hpp>
#include <samewhere/verify/decide.hpp>
#include <samewhere/verify/map_context.hpp>
#include <samewhere/verify/measure.hpp>

namespace samewhere::verify {

// The settings of one role: loop closing, relocalization, or recognition alone.
struct VerifierSettings {
  MeasureSettings measure;
  // Of queries without depth; measure.features where there is none.
  std::optional<features::Config> features_without_depth = {};

  const Config& config() const { return measure.verify; }
};

// Verification of loop candidates: measure, decide, then compare the accepted ones of one query.
// Holds no view and no map.
class LoopVerifier {
 public:
  explicit LoopVerifier(const VerifierSettings& settings) : settings_(settings) {}

  const Config& config() const { return settings_.config(); }

  // Geometry, odometry gate and competing loop. A candidate that similarity or the pause rejects is
  // not measured, unless verify.measure_all.
  core::Evidence measure(const core::Candidate& candidate, const features::View& query,
                         const features::View& match, const MapContext& map,
                         const History& history) const;

  // With the odometry gate and the competing loop of this map; the geometry stays.
  core::Evidence measured_again(const core::Candidate& candidate, core::Evidence evidence,
                                const MapContext& map) const;

  core::Verdict decide(const core::Candidate& candidate, const core::Evidence& evidence,
                       const History& history) const {
    return verify::decide(candidate, evidence, history, config());
  }

  // Recognized candidates at different places are competing hypotheses: the verdict on each may
  // become ambiguous. Rows of one query.
  void compare_candidates_of_one_query(const MapContext& map, const History& history,
                                       std::vector<core::LedgerRow>& rows) const;

 private:
  core::GeometryEvidence measure_geometry(const core::Candidate& candidate,
                                          const features::View& query, const features::View& match,
                                          const MapContext& map) const;

  VerifierSettings settings_;
};

// The best candidate of a query: accepted ones first, then by verify::rank. A loop that has fewer
// than max_competing_place_ratio of the inliers of another does not compete with it: a look-alike
// that is seen from where the query was taken overlaps more than the place itself that was seen
// from further on, but has fewer inliers. nullptr of no rows.
const core::LedgerRow* best_of_query(const std::vector<core::LedgerRow>& rows,
                                     const Config& config);

}  // namespace samewhere::verify
