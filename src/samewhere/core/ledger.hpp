#pragma once

#include <vector>

#include <samewhere/core/verdict.hpp>

namespace samewhere::core {

// One verified candidate. A later verdict on the same candidate is a further row.
struct LedgerRow {
  Candidate candidate;
  Verdict verdict;
};

// All verified candidates, in the order of their verdicts.
using Ledger = std::vector<LedgerRow>;

}  // namespace samewhere::core
