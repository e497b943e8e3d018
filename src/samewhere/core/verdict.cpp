#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/verdict.hpp>

namespace samewhere::core {

std::string_view name_of(Origin origin) {
  switch (origin) {
    case Origin::kRetrieved:
      return "retrieved";
    case Origin::kVisualWords:
      return "visual words";
    case Origin::kNeighbour:
      return "neighbour";
    case Origin::kPredicted:
      return "predicted";
    case Origin::kRelocalization:
      return "relocalization";
  }
  throw ContractError("promise broken: every Origin has a name");
}

std::string_view name_of(Refusal refusal) {
  switch (refusal) {
    case Refusal::kSimilarity:
      return "similarity";
    case Refusal::kPause:
      return "pause";
    case Refusal::kMatches:
      return "matches";
    case Refusal::kInliers:
      return "inliers";
    case Refusal::kSpread:
      return "spread";
    case Refusal::kPose:
      return "pose";
    case Refusal::kConsistency:
      return "consistency";
    case Refusal::kOdometry:
      return "odometry";
    case Refusal::kDeformation:
      return "deformation";
    case Refusal::kCompeting:
      return "competing";
    case Refusal::kSequence:
      return "sequence";
    case Refusal::kEvidence:
      return "evidence";
    case Refusal::kGraph:
      return "graph";
    case Refusal::kWithdrawn:
      return "withdrawn";
  }
  throw ContractError("promise broken: every Refusal has a name");
}

const Evidence& evidence_of(const Verdict& verdict) {
  return std::visit([](const auto& v) -> const Evidence& { return v.evidence; }, verdict);
}

bool is_loop(const Verdict& verdict) { return std::holds_alternative<LoopClosure>(verdict); }

std::string_view name_of(const Verdict& verdict) {
  if (is_loop(verdict)) return "LOOP";
  return std::holds_alternative<Rejection>(verdict) ? "NOT" : "AMBIGUOUS";
}

std::string_view stage_of(const Verdict& verdict) {
  if (const auto* rejection = std::get_if<Rejection>(&verdict)) return name_of(rejection->stage);
  if (const auto* ambiguous = std::get_if<Ambiguous>(&verdict)) return name_of(ambiguous->stage);
  return "accepted";
}

namespace {

std::string reason_for(const LoopClosure& loop) {
  const Evidence& evidence = loop.evidence;
  std::string reason = loop.is_by_hand ? "accepted by hand: " : "";
  if (!evidence.geometry) return reason + fmt::format("similarity {:.3f}", evidence.similarity);
  reason += fmt::format("{} inliers of one geometry, reprojection error {:.2f} px",
                        evidence.geometry->num_inliers, evidence.geometry->reprojection_rmse_px);
  if (evidence.sequence)
    reason += fmt::format("; {} consecutive views match", evidence.sequence->num_views);
  if (loop.overruled.is_valid() && evidence.competing_loop && evidence.competing_loop->gain)
    reason += fmt::format(
        "; replaces the competing hypothesis of the last loop, the place of frame {} at {:.2f} m: "
        "odometry supports this loop rather than its first one (gain {:.1f})",
        evidence.competing_loop->frame.index(), evidence.competing_loop->apart_m,
        *evidence.competing_loop->gain);
  return reason;
}

}  // namespace

std::string reason_of(const Verdict& verdict) {
  if (const auto* rejection = std::get_if<Rejection>(&verdict)) return rejection->reason;
  if (const auto* ambiguous = std::get_if<Ambiguous>(&verdict)) return ambiguous->reason;
  return reason_for(std::get<LoopClosure>(verdict));
}

}  // namespace samewhere::core
