#pragma once

#include <string>
#include <vector>

#include <samewhere/core/ledger.hpp>

namespace samewhere::report {

// Accepted loops in the order of their candidates.
std::vector<const core::LedgerRow*> accepted_rows(const core::Ledger& ledger);

// Candidates that were not accepted, most inliers first, then by similarity, then by id.
std::vector<const core::LedgerRow*> rejected_rows(const core::Ledger& ledger);

// One line each: the verdict ("rejected: odometry"), and what was measured.
std::string verdict_in_words(const core::Verdict& verdict);
std::string scores_of(const core::Evidence& evidence);

}  // namespace samewhere::report
