#pragma once

#include <vector>

#include <samewhere/core/truth.hpp>

namespace samewhere::evaluate {

// What a detector says about one query: 0-based positions of two frames in the source, and how sure
// it is (any finite scale, higher is surer).
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
  double recall_at_full_precision = 0.0;    // the largest at which no accepted match is wrong
  double precision_at_recall_35 = 0.0;  // the best at a recall of at least .35, 0 if not reached
  double precision_at_recall_70 = 0.0;
  int num_queries = 0;
  int num_with_loop = 0;  // queries with any true loop outside the window
  double max_recall = 0.0;
  int num_wrong = 0;  // with every match accepted
};

// Scores the matches of a sequence by sweeping the acceptance threshold over all their scores.
// `matches` has at most one row per query. Rows with query - match <= window_frames are no loops
// and are left out. A near match counts for nothing: it drops out of precision, and its query, if
// it has a loop, stays missed. Throws InputError on a row outside the matrix, a second row of a
// query or a score that is not finite.
PrecisionRecall precision_recall(const core::PlaceTruthMatrix& truth,
                                 const std::vector<Match>& matches, int window_frames);

// Accepted matches by what they are in truth.
struct AcceptedCounts {
  int num_right = 0;
  int num_wrong = 0;
  int num_near = 0;    // counts for nothing
  int num_recent = 0;  // inside the window: no loop at all
};

// Whether Truth::impostors names the two frames; the order of the two does not matter.
bool are_impostors(const std::vector<core::FramePair>& impostors, int query, int match);

// Accepted matches outside the window that Truth::impostors names. They are wrong ones.
int count_accepted_impostors(const std::vector<core::FramePair>& impostors,
                             const std::vector<Match>& accepted, int window_frames);

// Counts at one threshold: `accepted` may hold several rows of one query. Throws InputError on a
// row outside the matrix.
AcceptedCounts count_accepted(const core::PlaceTruthMatrix& truth,
                              const std::vector<Match>& accepted, int window_frames);

// Throws InputError naming the pair if it lies outside the matrix.
core::PlaceTruth place_truth_of(const core::PlaceTruthMatrix& truth, int query, int match);

}  // namespace samewhere::evaluate
