#pragma once

#include <string>
#include <vector>

#include <samewhere/report/record.hpp>

namespace samewhere::report {

// Loops in the order they were found.
std::vector<const core::LedgerRow*> accepted_rows(const core::Ledger& ledger);

// What was not accepted, most convincing first: by inliers, then by similarity, then by id.
std::vector<const core::LedgerRow*> refused_rows(const core::Ledger& ledger);

// The verdict as a person reads it ("refused: odometry"), and what was measured, in a line each.
std::string verdict_in_words(const core::Verdict& verdict);
std::string scores_of(const core::Evidence& evidence);

// HTML: for each of the first max_pairs rows the two thumbnails side by side with frame numbers,
// verdict, scores and reason; then how many more there are.
std::string pair_cards(const RunRecord& record, const std::vector<const core::LedgerRow*>& rows,
                       std::size_t max_pairs);

}  // namespace samewhere::report
