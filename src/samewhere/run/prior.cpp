#include <set>

#include <samewhere/report/figure.hpp>
#include <samewhere/report/funnel.hpp>
#include <samewhere/run/prior.hpp>
#include <samewhere/verify/decide.hpp>

namespace samewhere::run {
namespace {

verify::Config with_other_prior(verify::Config config) {
  const bool is_unique = config.prior == verify::Prior::kUnique;
  config.prior = is_unique ? verify::Prior::kRepetitive : verify::Prior::kUnique;
  return config;
}

// Accepted by one prior and left ambiguous by the other. What the pose graph rejected stays so.
bool is_decided_by_prior(const core::LedgerRow& row, const verify::Config& other) {
  if (row.candidate.origin == core::Origin::kRelocalization) return false;  // a place, no loop
  const auto* ambiguous = std::get_if<core::Ambiguous>(&row.verdict);
  if (other.prior == verify::Prior::kUnique)
    return ambiguous != nullptr && ambiguous->stage == core::Refusal::kEvidence;
  const auto* loop = std::get_if<core::LoopClosure>(&row.verdict);
  if (loop == nullptr || loop->is_by_hand) return false;
  return !core::is_loop(verify::decide(row.candidate, loop->evidence, {}, other));
}

}  // namespace

report::Figure prior_figure(const core::Ledger& ledger, const verify::Config& config) {
  const verify::Config other = with_other_prior(config);
  int num_candidates = 0;
  std::set<core::FrameId> queries;
  for (const core::LedgerRow* row : report::final_rows(ledger)) {
    if (!is_decided_by_prior(*row, other)) continue;
    ++num_candidates;
    queries.insert(row->candidate.query);
  }
  if (other.prior == verify::Prior::kUnique)
    return report::figure("prior", "repetitive; unique would accept {} more, of {} frames",
                          num_candidates, queries.size());
  return report::figure("prior",
                        "unique; repetitive would leave {} of these ambiguous, of {} frames",
                        num_candidates, queries.size());
}

}  // namespace samewhere::run
