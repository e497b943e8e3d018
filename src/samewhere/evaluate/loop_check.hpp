#pragma once

#include <optional>
#include <vector>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/core/truth.hpp>

namespace samewhere::evaluate {

// A loop that was accepted in SLAM.
struct AcceptedLoop {
  int query = 0;  // 0-based positions in the source
  int match = 0;
  double query_stamp_s = 0.0;
  double match_stamp_s = 0.0;
  std::optional<core::Rigid3> match_from_query;  // of camera 0; none: the loop has no pose
};

enum class LoopTruth { kRight, kWrong, kUnknown };

struct CheckedLoop {
  AcceptedLoop loop;
  LoopTruth truth = LoopTruth::kUnknown;
  // Of match_from_query against the true poses; absent where there is no pose or no true one.
  std::optional<double> translation_error_m;
  std::optional<double> rotation_error_deg;
};

struct LoopCheck {
  std::vector<CheckedLoop> loops;  // one per accepted loop, in their order
  int num_right = 0;
  int num_wrong = 0;
  int num_unknown = 0;
  int num_impostors = 0;  // wrong ones that join what Truth::impostors names
  int num_revisits = 0;   // that Truth::revisits names
  int num_closed = 0;     // of these, with a right loop in them
};

// Judges accepted loops by docs/evaluation.md: a loop is wrong if its match_from_query differs from
// the true one by more than 0.2 m or 6 degrees (truth interpolated as in truth_at). Where no true
// pose is known, or the loop has none, the place matrix says: same is right, different is wrong,
// near is unknown. Without either it is unknown.
// `scale` multiplies the translation of match_from_query (monocular: AteResult::scale).
// Throws InputError on a loop outside the matrix.
LoopCheck check_loops(const std::vector<AcceptedLoop>& loops, const core::Truth& truth,
                      double scale = 1.0);

// Whether one of them that is right has its query in the revisit.
bool is_closed(const core::FrameSpan& revisit, const std::vector<CheckedLoop>& loops);

}  // namespace samewhere::evaluate
