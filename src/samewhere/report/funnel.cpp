#include <iterator>
#include <map>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/report/funnel.hpp>

namespace samewhere::report {

std::vector<const core::LedgerRow*> final_rows(const core::Ledger& ledger) {
  std::map<core::CandidateId, const core::LedgerRow*> last;
  for (const core::LedgerRow& row : ledger) {
    core::require(row.candidate.id.is_valid(), "every candidate in the ledger has an id");
    last[row.candidate.id] = &row;
  }
  std::vector<const core::LedgerRow*> rows;
  for (const auto& [id, row] : last) rows.push_back(row);
  return rows;
}

Funnel funnel(const core::Ledger& ledger) {
  Funnel result;
  std::map<core::Refusal, FunnelRow> rows;
  for (const core::LedgerRow* row : final_rows(ledger)) {
    ++result.num_candidates;
    if (const auto* rejection = std::get_if<core::Rejection>(&row->verdict)) {
      ++rows[rejection->stage].num_rejected;
    } else if (const auto* ambiguous = std::get_if<core::Ambiguous>(&row->verdict)) {
      ++rows[ambiguous->stage].num_ambiguous;
      ++result.num_ambiguous;
    } else {
      ++result.num_accepted;
    }
  }
  int num_arrived = result.num_candidates;
  for (const core::Refusal stage : core::kAllRefusals) {
    FunnelRow& row = rows[stage];
    // a check of verify.method deformation alone
    if (stage == core::Refusal::kDeformation && row.num_rejected == 0) continue;
    row.stage = stage;
    row.num_arrived = num_arrived;
    num_arrived -= row.num_rejected + row.num_ambiguous;
    result.rows.push_back(row);
  }
  return result;
}

std::string_view question_of(core::Refusal check) {
  switch (check) {
    case core::Refusal::kSimilarity:
      return "are the image descriptors similar enough?";
    case core::Refusal::kPause:
      return "is the last accepted loop long enough ago?";
    case core::Refusal::kMatches:
      return "do enough features match?";
    case core::Refusal::kInliers:
      return "are enough matches inliers of one geometry?";
    case core::Refusal::kSpread:
      return "are the inliers spread over the image?";
    case core::Refusal::kPose:
      return "is a relative pose estimated, where one is required?";
    case core::Refusal::kConsistency:
      return "do the relative poses from both views' depth agree?";
    case core::Refusal::kOdometry:
      return "is the correction within the accumulated drift?";
    case core::Refusal::kDeformation:
      return "method deformation: does it bend the trajectory little?";
    case core::Refusal::kCompeting:
      return "does no other place explain the query?";
    case core::Refusal::kSequence:
      return "do neighbouring views match too, where nothing else decides?";
    case core::Refusal::kEvidence:
      return "would a look-alike place not give the same evidence?";
    case core::Refusal::kGraph:
      return "is it consistent with the loops before it?";
    case core::Refusal::kWithdrawn:
      return "is it consistent with the loops after it?";
  }
  throw core::ContractError("promise broken: every check has a question");
}

std::string funnel_text(const Funnel& funnel) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "  {:<12}{:>9}{:>9}{:>10}\n", "check", "arrived", "rejected", "ambiguous");
  for (const FunnelRow& row : funnel.rows)
    fmt::format_to(out, "  {:<12}{:>9}{:>9}{:>10}   {}\n", core::name_of(row.stage),
                   row.num_arrived, row.num_rejected, row.num_ambiguous, question_of(row.stage));
  fmt::format_to(out, "  {:<12}{:>9}\n", "accepted", funnel.num_accepted);
  return text;
}

}  // namespace samewhere::report
