#pragma once

#include <optional>
#include <string>
#include <vector>

#include <samewhere/core/ledger.hpp>

namespace samewhere::report {

// How a person is told of the match: its index, and of which session it is if not of the query's.
std::string name_of_match(const core::Candidate& candidate);

// loops.json, version 1: for each candidate its last verdict with stage, reason, every score of its
// Evidence by name, and match_from_query as [tx, ty, tz, qx, qy, qz, qw] or null. Scores that are
// not finite are left out; those of a geometry that was not found are null. "num_inliers" are of
// "num_matches", which are those around the pose found; "num_first_matches": of the descriptors
// alone, if these are others. "is_foretold": true where no search found the candidate,
// "is_by_features": true where it was found by its features and not by its looks, "is_lost": true
// where nobody knew where the view was taken; "is_by_hand": true where a person accepted it;
// "overruled": the first of the loops that went for its sake; "query_session" and "match_session"
// where the match is a frame of an earlier session, one of the map that the run started in. With
// "scale": "unknown" where lengths are in map units, not metres.
std::string loops_json(const core::Ledger& ledger, bool is_scale_unknown = false);

// One row as an entry of loops.json, on one line; with "query_session" and "match_session" if the
// query is not of the first session.
std::string ledger_row_json(const core::LedgerRow& row);

// One line of matches.txt or accepted.txt.
struct ScoredPair {
  core::FrameId query;
  core::FrameId match;
  double score = 0.0;  // finite
};

// The loops of a ledger, scored by similarity, in the order of the queries.
std::vector<ScoredPair> accepted_pairs(const core::Ledger& ledger);

// Lines "query match score"; the score has all digits it needs to be read back as it was.
std::string pairs_text(const std::vector<ScoredPair>& pairs);

}  // namespace samewhere::report
