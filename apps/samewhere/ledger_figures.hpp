#pragma once

#include <vector>

#include <samewhere/core/ledger.hpp>
#include <samewhere/report/record.hpp>
#include <samewhere/verify/config.hpp>

namespace samewhere::app {

// All that was measured of one candidate, with the bar that each figure was held against.
std::vector<report::Figure> figures_of(const core::LedgerRow& row, const verify::Config& config);

}  // namespace samewhere::app
