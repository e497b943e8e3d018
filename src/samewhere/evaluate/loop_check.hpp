#pragma once

#include <optional>
#include <vector>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/core/truth.hpp>

namespace samewhere::evaluate {

// An accepted loop closure of SLAM.
struct AcceptedLoop {
  int query = 0;  // 0-based positions in the source
  int match = 0;
  double query_stamp_s = 0.0;
  double match_stamp_s = 0.0;
  std::optional<core::Rigid3> match_from_query;  // of camera 0; none: the loop has no pose
};

enum class LoopTruth { kTrue, kFalse, kUnknown };

struct CheckedLoop {
  AcceptedLoop loop;
  LoopTruth truth = LoopTruth::kUnknown;
  // Of match_from_query against the ground truth; absent where either is missing.
  std::optional<double> translation_error_m;
  std::optional<double> rotation_error_deg;
};

struct LoopCheck {
  std::vector<CheckedLoop> loops;  // one per accepted loop, in their order
  int num_true = 0;
  int num_false = 0;
  int num_unknown = 0;
  int num_aliased = 0;   // false ones of Truth::aliased_pairs
  int num_revisits = 0;  // of Truth::revisits
  int num_closed = 0;    // of these, with a true loop
};

// Classifies accepted loops by docs/evaluation.md: a loop is false if its match_from_query differs
// from the true one by more than 0.2 m or 6 degrees (truth interpolated as in truth_at). Without a
// true pose, or without match_from_query, the place matrix decides: same is true, different is
// false, near is unknown. Without either it is unknown. `scale` multiplies the translation of
// match_from_query (monocular: AteResult::scale). Throws InputError on a loop outside the matrix.
LoopCheck check_loops(const std::vector<AcceptedLoop>& loops, const core::Truth& truth,
                      double scale = 1.0);

// Whether the query of a true loop lies in the revisit.
bool is_closed(const core::FrameSpan& revisit, const std::vector<CheckedLoop>& loops);

}  // namespace samewhere::evaluate
