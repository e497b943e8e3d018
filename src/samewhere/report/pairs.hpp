#pragma once

#include <string>
#include <vector>

#include <samewhere/report/record.hpp>

namespace samewhere::report {

// Loops in the order they were found.
std::vector<const core::LedgerRow*> accepted_rows(const core::Ledger& ledger);

// What was not accepted, most convincing first: by inliers, then by similarity, then by id.
std::vector<const core::LedgerRow*> refused_rows(const core::Ledger& ledger);

// HTML: for each of the first max_pairs rows the two thumbnails side by side with frame numbers,
// verdict, scores and reason; then how many more there are.
std::string pair_cards(const RunRecord& record, const std::vector<const core::LedgerRow*>& rows,
                       std::size_t max_pairs);

}  // namespace samewhere::report
