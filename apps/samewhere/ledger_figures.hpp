#pragma once

#include <vector>

#include <samewhere/core/ledger.hpp>
#include <samewhere/report/record.hpp>
#include <samewhere/verify/config.hpp>

namespace samewhere::app {

// All measurements of one candidate with their thresholds.
std::vector<report::Figure> figures_of(const core::LedgerRow& row, const verify::Config& config);

}  // namespace samewhere::app
