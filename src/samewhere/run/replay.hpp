#pragma once

#include <vector>

#include <samewhere/core/ledger.hpp>
#include <samewhere/verify/config.hpp>

namespace samewhere::run {

// What the judge would have said with other thresholds.
enum class Replay {
  kSame,        // loop or no loop, as before
  kChanged,     //
  kUnmeasured,  // the next check needs what was never measured: nobody can tell without the
                // pictures
  kGraph        // the judge accepted it and still does; the map that refused it is not replayed
};

struct ReplayedRow {
  core::LedgerRow before;
  core::Verdict after;  // what the judge says of what was measured
  Replay outcome = Replay::kSame;
};

// Judges all candidates of a finished run anew, in their order, from what was measured of them; the
// pause after a loop follows the new verdicts.
std::vector<ReplayedRow> replay(const core::Ledger& ledger, const verify::Config& config);

}  // namespace samewhere::run
