#include <algorithm>
#include <numbers>

#include <samewhere/evaluate/loop_check.hpp>
#include <samewhere/evaluate/precision_recall.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>

namespace samewhere::evaluate {
namespace {

constexpr double kMaxTranslationError_m = 0.2;
constexpr double kMaxRotationError_deg = 6.0;

std::optional<core::Rigid3> true_match_from_query(const AcceptedLoop& loop,
                                                  const core::Trajectory& truth) {
  const std::optional<core::Rigid3> world_from_query = truth_at(truth, loop.query_stamp_s);
  const std::optional<core::Rigid3> world_from_match = truth_at(truth, loop.match_stamp_s);
  if (!world_from_query || !world_from_match) return std::nullopt;
  return core::inverse(*world_from_match) * *world_from_query;
}

CheckedLoop check_by_pose(const AcceptedLoop& loop, const core::Rigid3& match_from_query,
                          const core::Rigid3& true_pose) {
  const core::Rigid3 error = core::inverse(true_pose) * match_from_query;
  const double translation_error_m = error.translation.norm();
  const double rotation_error_deg = core::angle_rad(error.rotation) * 180.0 / std::numbers::pi;
  // written so that a pose that is not finite is false
  const bool is_true =
      translation_error_m <= kMaxTranslationError_m && rotation_error_deg <= kMaxRotationError_deg;
  return {loop, is_true ? LoopTruth::kTrue : LoopTruth::kFalse, translation_error_m,
          rotation_error_deg};
}

LoopTruth truth_by_matrix(const AcceptedLoop& loop, const core::PlaceTruthMatrix& places) {
  switch (place_truth_of(places, loop.query, loop.match)) {
    case core::PlaceTruth::kSame:
      return LoopTruth::kTrue;
    case core::PlaceTruth::kDifferent:
      return LoopTruth::kFalse;
    case core::PlaceTruth::kNear:
      break;
  }
  return LoopTruth::kUnknown;
}

CheckedLoop check(const AcceptedLoop& loop, const core::Truth& truth, double scale) {
  const std::optional<core::Rigid3> true_pose = true_match_from_query(loop, truth.trajectory);
  if (true_pose && loop.match_from_query) {
    core::Rigid3 match_from_query = *loop.match_from_query;
    match_from_query.translation *= scale;
    return check_by_pose(loop, match_from_query, *true_pose);
  }
  CheckedLoop checked{loop, LoopTruth::kUnknown, std::nullopt, std::nullopt};
  if (truth.places) checked.truth = truth_by_matrix(loop, *truth.places);
  return checked;
}

}  // namespace

LoopCheck check_loops(const std::vector<AcceptedLoop>& loops, const core::Truth& truth,
                      double scale) {
  LoopCheck result;
  for (const AcceptedLoop& loop : loops) {
    result.loops.push_back(check(loop, truth, scale));
    const LoopTruth found = result.loops.back().truth;
    result.num_true += found == LoopTruth::kTrue ? 1 : 0;
    result.num_false += found == LoopTruth::kFalse ? 1 : 0;
    result.num_unknown += found == LoopTruth::kUnknown ? 1 : 0;
    const bool is_aliased =
        found == LoopTruth::kFalse && is_aliased_pair(truth.aliased_pairs, loop.query, loop.match);
    result.num_aliased += is_aliased ? 1 : 0;
  }
  for (const core::FrameSpan& revisit : truth.revisits.value_or(std::vector<core::FrameSpan>{})) {
    ++result.num_revisits;
    result.num_closed += is_closed(revisit, result.loops) ? 1 : 0;
  }
  return result;
}

bool is_closed(const core::FrameSpan& revisit, const std::vector<CheckedLoop>& loops) {
  return std::any_of(loops.begin(), loops.end(), [&](const CheckedLoop& checked) {
    return checked.truth == LoopTruth::kTrue && revisit.first <= checked.loop.query &&
           checked.loop.query <= revisit.last;
  });
}

}  // namespace samewhere::evaluate
