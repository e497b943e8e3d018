#pragma once

#include <map>
#include <vector>

#include <samewhere/core/ledger.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/report/record.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::run {

// The feature matches between the views of candidates, for the report: of accepted ones first, then
// of the others, most inliers first, at most max_candidates. Candidates with a view that is no
// keyframe of the map are left out. A match counts as an inlier if the candidate's relative pose
// takes the point of the match to within verify.max_error_px of the query's feature; without a pose
// there are none.
std::map<core::CandidateId, std::vector<report::ImageMatch>> candidate_matches(
    const core::Ledger& ledger, const scene::MapVersion& map, const pipeline::Config& config,
    std::size_t max_candidates);

// The thresholds of the scores in loops.json, in the order of the checks. Those of checks that the
// configuration leaves out are absent.
std::vector<report::ScoreLimit> score_limits(const verify::Config& config);

}  // namespace samewhere::run
