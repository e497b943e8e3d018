#pragma once

#include <vector>

#include <samewhere/core/ledger.hpp>
#include <samewhere/verify/config.hpp>

namespace samewhere::run {

// The verdict with other thresholds.
enum class Replay {
  kSame,        // as before: loop, rejected or ambiguous
  kChanged,     //
  kUnmeasured,  // the next check needs a measurement that the run did not make
                // (--measure-all)
  kGraph        // still accepted by the verifier; the pose graph that rejected it is not replayed
};

struct ReplayedRow {
  core::LedgerRow before;
  core::Verdict after;  // on the same evidence
  Replay outcome = Replay::kSame;
};

// Decides all candidates of a finished run again, in their order, from their evidence; the
// pause after a loop follows the new verdicts. As in the run, a relocalization needs neither a
// relative pose nor a sequence. `config`: the one in force, with other thresholds.
std::vector<ReplayedRow> replay(const core::Ledger& ledger, const verify::Config& config);

}  // namespace samewhere::run
