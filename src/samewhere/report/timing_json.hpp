#pragma once

#include <string>

#include <samewhere/core/timing.hpp>
#include <samewhere/report/table.hpp>

namespace samewhere::report {

// timing.json: per stage count, median_ms, p95_ms, p99_ms, total_ms and processor_ms (in total, of
// the stage's thread); peak_memory_mib; and frames_per_second, eq. (26), by the stage
// kWholeFrameStage (null if it was not timed).
std::string timing_json(const core::Timings& timings, double peak_memory_mib);

// The stages of such a document as a table, most CPU time first; CPU time is given per whole frame.
// Throws InputError that begins with `name` if the text is no such document.
Table stage_table(const std::string& json, const std::string& name);

}  // namespace samewhere::report
