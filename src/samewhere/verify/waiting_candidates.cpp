#include <algorithm>
#include <string_view>
#include <utility>

#include <samewhere/verify/waiting_candidates.hpp>

namespace samewhere::verify {
namespace {

// A later loop can decide it. A relocalization is no loop.
bool is_worth_waiting(const core::LedgerRow& row) {
  const std::string_view stage = core::stage_of(row.verdict);
  const auto& geometry = core::evidence_of(row.verdict).geometry;
  return row.candidate.origin != core::Origin::kRelocalization &&
         (stage == core::name_of(core::Refusal::kCompeting) ||
          stage == core::name_of(core::Refusal::kEvidence)) &&
         geometry && geometry->match_from_query;
}

std::optional<core::LedgerRow> competitor_of(const core::LedgerRow& row,
                                             const std::vector<core::LedgerRow>& rows) {
  const auto& place = core::evidence_of(row.verdict).competing_place;
  if (!place) return std::nullopt;
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const core::LedgerRow& other) {
    return other.candidate.query == row.candidate.query && other.candidate.match == place->frame;
  });
  return found == rows.end() ? std::nullopt : std::optional(*found);
}

bool has_same_kind(const core::Verdict& a, const core::Verdict& b) {
  return a.index() == b.index();
}

}  // namespace

void WaitingCandidates::add(const std::vector<core::LedgerRow>& rows) {
  if (verifier_.config().asked_again_per_keyframe == 0) return;
  for (const core::LedgerRow& row : rows)
    if (is_worth_waiting(row)) waiting_.push_back({row, competitor_of(row, rows), num_changes_});
}

std::vector<core::LedgerRow> WaitingCandidates::ask_again(const MapContext& map, int max_asked) {
  std::vector<core::CandidateId> loops = map.loops();
  if (loops != loops_) {
    loops_ = std::move(loops);
    ++num_changes_;
  }
  std::vector<core::LedgerRow> changed;
  int num_asked = 0;
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    if (num_asked == max_asked) break;
    next_ = next_ + 1 < waiting_.size() ? next_ + 1 : 0;
    Waiting& waiting = waiting_[next_];
    if (waiting.asked_at == num_changes_) continue;
    waiting.asked_at = num_changes_;
    ++num_asked;
    core::Verdict verdict = decided_again(waiting, map);
    if (has_same_kind(verdict, waiting.row.verdict)) continue;
    waiting.row.verdict = std::move(verdict);
    changed.push_back(waiting.row);
  }
  std::erase_if(waiting_,
                [](const Waiting& waiting) { return core::is_loop(waiting.row.verdict); });
  return changed;
}

bool WaitingCandidates::is_ruled_out(const core::LedgerRow& competitor,
                                     const MapContext& map) const {
  core::Evidence evidence =
      verifier_.measured_again(competitor.candidate, core::evidence_of(competitor.verdict), map);
  evidence.competing_place.reset();
  return contradicts_loops(evidence, verifier_.config()) ||
         !is_recognized(verifier_.decide(competitor.candidate, evidence, {}));
}

core::Verdict WaitingCandidates::decided_again(const Waiting& waiting,
                                               const MapContext& map) const {
  const core::Candidate& candidate = waiting.row.candidate;
  const Config& config = verifier_.config();
  core::Evidence evidence =
      verifier_.measured_again(candidate, core::evidence_of(waiting.row.verdict), map);
  if (waiting.competitor && is_ruled_out(*waiting.competitor, map))
    evidence.competing_place.reset();
  core::Verdict verdict = verifier_.decide(candidate, evidence, {});
  const auto* ambiguous = std::get_if<core::Ambiguous>(&verdict);
  if (ambiguous != nullptr && contradicts_loops(evidence, config))
    return core::Rejection{candidate.id, evidence, core::Refusal::kCompeting, ambiguous->reason};
  const core::OdometryEvidence odometry = evidence.odometry.value_or(core::OdometryEvidence{});
  const bool is_told_by_loops = odometry.look_alike_gain_with_loops &&
                                *odometry.look_alike_gain_with_loops >= config.min_look_alike_gain;
  if (core::is_loop(verdict) && !loops_.empty() && !is_told_by_loops) return waiting.row.verdict;
  return verdict;
}

}  // namespace samewhere::verify
