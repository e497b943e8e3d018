#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <samewhere/core/ledger.hpp>

namespace samewhere::report {

// The last verdict on each candidate, in the order of their ids. The pointers live as long as the
// ledger.
std::vector<const core::LedgerRow*> final_rows(const core::Ledger& ledger);

struct FunnelRow {
  core::Refusal stage = core::Refusal::kSimilarity;
  int num_arrived = 0;
  int num_rejected = 0;
  int num_ambiguous = 0;
};

// Candidates decided by each check: one row per check, in the order of the checks.
struct Funnel {
  std::vector<FunnelRow> rows;
  int num_candidates = 0;
  int num_accepted = 0;
  int num_ambiguous = 0;
};

// Of the final verdicts.
Funnel funnel(const core::Ledger& ledger);

// The check as a question for the user: "do enough features match?".
std::string_view question_of(core::Refusal check);

// The funnel as an aligned table for the terminal; ends with a line break.
std::string funnel_text(const Funnel& funnel);

}  // namespace samewhere::report
