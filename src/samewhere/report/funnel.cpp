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
  std::map<core::Refusal, int> num_refused;
  for (const core::LedgerRow* row : final_rows(ledger)) {
    ++result.num_candidates;
    if (const auto* rejection = std::get_if<core::Rejection>(&row->verdict))
      ++num_refused[rejection->stage];
    else if (core::is_loop(row->verdict))
      ++result.num_accepted;
    else
      ++result.num_ambiguous;
  }
  int num_arrived = result.num_candidates;
  for (const core::Refusal stage : core::kAllRefusals) {
    result.rows.push_back({stage, num_arrived, num_refused[stage]});
    num_arrived -= num_refused[stage];
  }
  return result;
}

std::string_view question_of(core::Refusal refusal) {
  switch (refusal) {
    case core::Refusal::kSimilarity:
      return "do the two views look alike?";
    case core::Refusal::kPause:
      return "is it not just after another loop?";
    case core::Refusal::kMatches:
      return "do enough features match?";
    case core::Refusal::kInliers:
      return "do enough matches agree on one geometry?";
    case core::Refusal::kSpread:
      return "are they spread over the image?";
    case core::Refusal::kPose:
      return "do they give a relative pose, where one is needed?";
    case core::Refusal::kConsistency:
      return "do both views find the same relative pose?";
    case core::Refusal::kOdometry:
      return "does it fit odometry?";
    case core::Refusal::kCompeting:
      return "does no other place explain the query?";
    case core::Refusal::kSequence:
      return "do the views around it go on to match, where nothing else can tell?";
    case core::Refusal::kGraph:
      return "does it fit the loops before it?";
    case core::Refusal::kWithdrawn:
      return "does it fit the loops after it?";
  }
  throw core::ContractError("promise broken: every Refusal has a question");
}

std::string funnel_text(const Funnel& funnel) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "  {:<12}{:>9}{:>9}\n", "check", "arrived", "refused");
  for (const FunnelRow& row : funnel.rows)
    fmt::format_to(out, "  {:<12}{:>9}{:>9}   {}\n", core::name_of(row.stage), row.num_arrived,
                   row.num_refused, question_of(row.stage));
  fmt::format_to(out, "  {:<12}{:>9}\n", "ambiguous", funnel.num_ambiguous);
  fmt::format_to(out, "  {:<12}{:>9}\n", "accepted", funnel.num_accepted);
  return text;
}

}  // namespace samewhere::report
