#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include <samewhere/report/funnel.hpp>
#include <samewhere/report/pairs.hpp>

namespace samewhere::report {
namespace {

// Inliers, then similarity (the least where it is no number, so that the order stays one).
std::pair<int, double> strength_of(const core::LedgerRow& row) {
  const auto& geometry = core::evidence_of(row.verdict).geometry;
  const double similarity = row.candidate.similarity;
  return {geometry ? geometry->num_inliers : 0, std::isfinite(similarity) ? similarity : -1.0};
}

}  // namespace

std::string scores_of(const core::Evidence& evidence) {
  std::string text = fmt::format("similarity {:.2f}", evidence.similarity);
  if (evidence.geometry)
    fmt::format_to(std::back_inserter(text), " · {} matches · {} inliers",
                   evidence.geometry->num_guided_matches > 0 ? evidence.geometry->num_guided_matches
                                                             : evidence.geometry->num_matches,
                   evidence.geometry->num_inliers);
  return text;
}

std::string verdict_in_words(const core::Verdict& verdict) {
  if (core::is_loop(verdict)) return "accepted";
  if (std::holds_alternative<core::Ambiguous>(verdict)) return "ambiguous";
  return fmt::format("rejected: {}", core::stage_of(verdict));
}

std::vector<const core::LedgerRow*> accepted_rows(const core::Ledger& ledger) {
  std::vector<const core::LedgerRow*> rows = final_rows(ledger);
  std::erase_if(rows, [](const core::LedgerRow* row) { return !core::is_loop(row->verdict); });
  return rows;
}

std::vector<const core::LedgerRow*> rejected_rows(const core::Ledger& ledger) {
  std::vector<const core::LedgerRow*> rows = final_rows(ledger);
  std::erase_if(rows, [](const core::LedgerRow* row) { return core::is_loop(row->verdict); });
  std::stable_sort(rows.begin(), rows.end(),
                   [](const core::LedgerRow* a, const core::LedgerRow* b) {
                     return strength_of(*a) > strength_of(*b);
                   });
  return rows;
}

}  // namespace samewhere::report
