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
  const auto* ambiguous = std::get_if<core::Ambiguous>(&row.verdict);
  if (other.prior == verify::Prior::kUnique)
    return ambiguous != nullptr && ambiguous->stage == core::Refusal::kEvidence;
  const auto* loop = std::get_if<core::LoopClosure>(&row.verdict);
  if (loop == nullptr || loop->is_by_hand) return false;
  return !core::is_loop(verify::decide(row.candidate, loop->evidence, {}, other));
}

struct Decided {
  int num_candidates = 0;
  std::set<core::FrameId> queries;
};

Decided decided_by_prior(const core::Ledger& ledger, bool are_relocalizations,
                         const verify::Config& other) {
  Decided decided;
  for (const core::LedgerRow* row : report::final_rows(ledger)) {
    const bool is_relocalization = row->candidate.origin == core::Origin::kRelocalization;
    if (is_relocalization != are_relocalizations || !is_decided_by_prior(*row, other)) continue;
    ++decided.num_candidates;
    decided.queries.insert(row->candidate.query);
  }
  return decided;
}

}  // namespace

report::Figure prior_figure(const core::Ledger& ledger, const verify::Config& config) {
  const verify::Config other = with_other_prior(config);
  const Decided decided = decided_by_prior(ledger, false, other);
  if (other.prior == verify::Prior::kUnique)
    return report::figure("prior", "repetitive; unique would accept {} more, of {} frames",
                          decided.num_candidates, decided.queries.size());
  return report::figure("prior",
                        "unique; repetitive would leave {} of these ambiguous, of {} frames",
                        decided.num_candidates, decided.queries.size());
}

std::optional<report::Figure> relocalization_prior_figure(const core::Ledger& ledger,
                                                          const verify::Config& config) {
  const verify::Config other = with_other_prior(config);
  const Decided decided = decided_by_prior(ledger, true, other);
  if (decided.num_candidates == 0) return std::nullopt;
  if (other.prior == verify::Prior::kUnique)
    return report::figure("prior, relocalization",
                          "repetitive; unique would accept {} candidates, of {} frames, at once",
                          decided.num_candidates, decided.queries.size());
  return report::figure("prior, relocalization",
                        "unique; repetitive would leave {} of these ambiguous, of {} frames",
                        decided.num_candidates, decided.queries.size());
}

}  // namespace samewhere::run
