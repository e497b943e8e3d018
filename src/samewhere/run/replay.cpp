#include <map>
#include <utility>

#include <samewhere/run/replay.hpp>
#include <samewhere/verify/decide.hpp>
#include <samewhere/verify/pending_candidates.hpp>

namespace samewhere::run {
namespace {

bool is_refused_by_graph(const core::Verdict& verdict) {
  const auto* refused = std::get_if<core::Rejection>(&verdict);
  return refused != nullptr &&
         (refused->stage == core::Refusal::kGraph || refused->stage == core::Refusal::kWithdrawn);
}

// Closed by `ledger force`: a loop whatever the thresholds.
bool is_by_hand(const core::Verdict& verdict) {
  const auto* loop = std::get_if<core::LoopClosure>(&verdict);
  return loop != nullptr && loop->is_by_hand;
}

// The run stopped measuring at its own thresholds.
bool is_unmeasured(const core::Verdict& before, const core::Verdict& after,
                   const verify::Config& config) {
  const core::Evidence& evidence = core::evidence_of(before);
  if (verify::is_pending(after) && !evidence.sequence) return true;
  // a run of an earlier version, which did not measure what tells a place from a look-alike
  const bool is_earlier = evidence.odometry && !evidence.odometry->look_alike_gain &&
                          core::stage_of(after) == "evidence";
  if (is_earlier && core::is_loop(before)) return true;
  if (evidence.geometry || !config.require_geometry) return false;
  const auto* refused = std::get_if<core::Rejection>(&after);
  return refused == nullptr || refused->stage == core::Refusal::kMatches;
}

// The loops of the map decide later, by asking again, which is not replayed.
bool is_told_later(const core::Verdict& before, const core::Verdict& after) {
  return std::holds_alternative<core::Ambiguous>(after) &&
         core::stage_of(before) == core::name_of(core::Refusal::kCompeting);
}

Replay outcome_of(const core::LedgerRow& before, const core::Verdict& after,
                  const verify::Config& config) {
  if (is_unmeasured(before.verdict, after, config)) return Replay::kUnmeasured;
  if (is_refused_by_graph(before.verdict) && core::is_loop(after)) return Replay::kGraph;
  if (before.verdict.index() == after.index() || is_told_later(before.verdict, after))
    return Replay::kSame;
  return Replay::kChanged;
}

// The sequence of a candidate depends on which other candidates pass: it is computed again.
core::Evidence without_sequence(core::Evidence evidence) {
  if (evidence.sequence) {
    evidence.sequence->num_views = 0;
    evidence.sequence->num_inliers = 0;
    evidence.sequence->is_over = false;
  }
  return evidence;
}

// Decides in the order of the run.
class Replayer {
 public:
  explicit Replayer(const verify::Config& config) : config_(config), pending_(config) {}

  void decide(const core::LedgerRow& row) {
    const core::Evidence evidence = without_sequence(core::evidence_of(row.verdict));
    if (evidence.sequence && evidence.sequence->query_view > view_) {
      view_ = evidence.sequence->query_view;
      settle(pending_.settle(view_ - 1));  // the run has seen all views before, found or not
    }
    core::Verdict verdict =
        verify::decide(row.candidate, evidence, history_, config_for(row.candidate));
    if (core::is_loop(verdict)) history_.last_loop_query = row.candidate.query;
    if (verify::is_pending(verdict) && evidence.sequence) pending_.add(row.candidate, evidence);
    verdicts_.insert_or_assign(row.candidate.id, std::move(verdict));
  }

  std::map<core::CandidateId, core::Verdict> verdicts() && {
    settle(pending_.settle_all());
    return std::move(verdicts_);
  }

 private:
  verify::Config config_for(const core::Candidate& candidate) const {
    verify::Config config = config_;
    if (candidate.origin == core::Origin::kRelocalization) {
      config.require_pose = false;
      config.min_views = 1;
    }
    return config;
  }

  void settle(const std::vector<core::LedgerRow>& rows) {
    for (const core::LedgerRow& row : rows)
      verdicts_.insert_or_assign(row.candidate.id, row.verdict);
  }

  verify::Config config_;
  verify::History history_;
  verify::PendingCandidates pending_;
  int view_ = 0;
  std::map<core::CandidateId, core::Verdict> verdicts_;
};

}  // namespace

std::vector<ReplayedRow> replay(const core::Ledger& ledger, const verify::Config& config) {
  Replayer replayer(config);
  for (const core::LedgerRow& row : ledger) replayer.decide(row);
  const auto verdicts = std::move(replayer).verdicts();
  std::vector<ReplayedRow> rows;
  for (const core::LedgerRow& row : ledger) {
    const core::Verdict& after =
        is_by_hand(row.verdict) ? row.verdict : verdicts.at(row.candidate.id);
    rows.push_back({row, after, outcome_of(row, after, config)});
  }
  return rows;
}

}  // namespace samewhere::run
