#pragma once

#include <vector>

#include <samewhere/core/truth.hpp>

namespace samewhere::evaluate {

// The match of one query: 0-based positions of two frames in the source, and a score (finite,
// higher is more similar).
struct Match {
  int query = 0;
  int match = 0;
  double score = 0.0;
};

struct PrecisionRecallPoint {
  double recall = 0.0;
  double precision = 0.0;
  double score = 0.0;  // all matches scoring at least this are accepted
};

// Protocol pr-v2 of docs/evaluation.md.
struct PrecisionRecall {
  std::vector<PrecisionRecallPoint> curve;  // recall ascends; empty if nothing can be scored
  double auc = 0.0;                         // trapezoid from recall 0 at the first precision
  double recall_at_full_precision = 0.0;    // the largest without an accepted false match
  double precision_at_recall_35 = 0.0;  // the best at a recall of at least .35, 0 if not reached
  double precision_at_recall_70 = 0.0;
  int num_queries = 0;
  int num_with_loop = 0;  // queries with any true loop outside the window
  double max_recall = 0.0;
  int num_false = 0;  // with every match accepted
};

// Scores the matches of a sequence by sweeping the acceptance threshold over all their scores.
// `matches` has at most one row per query. Rows with query - match <= window_frames are no loops
// and are left out. A near match is ignored: it does not count for precision, and its query, if it
// has a loop, counts as missed. Throws InputError on a row outside the matrix, a second row of a
// query or a score that is not finite.
PrecisionRecall precision_recall(const core::PlaceTruthMatrix& truth,
                                 const std::vector<Match>& matches, int window_frames);

// Accepted matches by their place truth.
struct AcceptedCounts {
  int num_true = 0;
  int num_false = 0;
  int num_near = 0;    // ignored
  int num_recent = 0;  // inside the window: no loop
};

// Whether the two frames, in either order, are one of Truth::aliased_pairs.
bool is_aliased_pair(const std::vector<core::FramePair>& aliased_pairs, int query, int match);

// Accepted matches outside the window that are one of Truth::aliased_pairs, all of them false.
int count_accepted_aliased(const std::vector<core::FramePair>& aliased_pairs,
                           const std::vector<Match>& accepted, int window_frames);

// Counts at one threshold: `accepted` may hold several rows of one query. Throws InputError on a
// row outside the matrix.
AcceptedCounts count_accepted(const core::PlaceTruthMatrix& truth,
                              const std::vector<Match>& accepted, int window_frames);

// Throws InputError naming the pair if it lies outside the matrix.
core::PlaceTruth place_truth_of(const core::PlaceTruthMatrix& truth, int query, int match);

}  // namespace samewhere::evaluate
