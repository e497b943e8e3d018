#pragma once

#include <optional>

#include <samewhere/core/ledger.hpp>
#include <samewhere/report/record.hpp>
#include <samewhere/verify/config.hpp>

namespace samewhere::run {

// Which prior was in force, and how many candidates, of how many frames, the other prior decides
// differently on the same evidence: "repetitive; unique would accept 12 more, of 5 frames". The
// numbers are those two.
report::Figure prior_figure(const core::Ledger& ledger, const verify::Config& config);

// The same of relocalization, whose candidates are places and no loops. Nothing without any.
std::optional<report::Figure> relocalization_prior_figure(const core::Ledger& ledger,
                                                          const verify::Config& config);

}  // namespace samewhere::run
