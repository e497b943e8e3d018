#pragma once

#include <vector>

#include <samewhere/core/verdict.hpp>

namespace samewhere::core {

// One judged candidate. A later verdict on the same candidate is a further row.
struct LedgerRow {
  Candidate candidate;
  Verdict verdict;
};

// Every candidate ever judged, in the order of the judgements.
using Ledger = std::vector<LedgerRow>;

}  // namespace samewhere::core
