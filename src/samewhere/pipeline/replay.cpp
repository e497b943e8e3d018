#include <samewhere/pipeline/replay.hpp>
#include <samewhere/verify/decide.hpp>

namespace samewhere::pipeline {
namespace {

bool is_refused_by_graph(const core::Verdict& verdict) {
  const auto* refused = std::get_if<core::Rejection>(&verdict);
  return refused != nullptr &&
         (refused->stage == core::Refusal::kGraph || refused->stage == core::Refusal::kWithdrawn);
}

// The run stopped measuring at its own thresholds.
bool is_unmeasured(const core::Evidence& evidence, const core::Verdict& after,
                   const verify::Config& config) {
  if (evidence.geometry || !config.require_geometry) return false;
  const auto* refused = std::get_if<core::Rejection>(&after);
  return refused == nullptr || refused->stage == core::Refusal::kMatches;
}

Replay outcome_of(const core::LedgerRow& before, const core::Verdict& after,
                  const verify::Config& config) {
  const core::Evidence& evidence = core::evidence_of(before.verdict);
  if (is_unmeasured(evidence, after, config)) return Replay::kUnmeasured;
  if (is_refused_by_graph(before.verdict) && core::is_loop(after)) return Replay::kGraph;
  return core::is_loop(before.verdict) == core::is_loop(after) ? Replay::kSame : Replay::kChanged;
}

}  // namespace

std::vector<ReplayedRow> replay(const core::Ledger& ledger, const verify::Config& config) {
  std::vector<ReplayedRow> rows;
  verify::History history;
  for (const core::LedgerRow& row : ledger) {
    ReplayedRow replayed{row,
                         decide(row.candidate, core::evidence_of(row.verdict), history, config)};
    if (core::is_loop(replayed.after)) history.last_loop_query = row.candidate.query;
    replayed.outcome = outcome_of(row, replayed.after, config);
    rows.push_back(std::move(replayed));
  }
  return rows;
}

}  // namespace samewhere::pipeline
