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
  int num_refused = 0;
};

// Where candidates were refused: one row per check, in the order of the checks.
struct Funnel {
  std::vector<FunnelRow> rows;
  int num_candidates = 0;
  int num_accepted = 0;
  int num_ambiguous = 0;  // passed the checks, but something else explains the view as well
};

// Of the final verdicts.
Funnel funnel(const core::Ledger& ledger);

// What a check asks, for a person: "do enough matches agree on one geometry?".
std::string_view question_of(core::Refusal refusal);

// The funnel as an aligned table for the terminal, ends with a line break.
std::string funnel_text(const Funnel& funnel);

}  // namespace samewhere::report
