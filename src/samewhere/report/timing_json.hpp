#pragma once

#include <string>

#include <samewhere/core/timing.hpp>
#include <samewhere/report/table.hpp>

namespace samewhere::report {

// timing.json: per stage count, median_ms, p95_ms, p99_ms, total_ms and processor_ms (in all, of
// the stage's thread); peak_memory_mib; and frames_per_second, eq. (26), by the stage
// kWholeFrameStage (null if it was not timed).
std::string timing_json(const core::Timings& timings, double peak_memory_mib);

// Where the time went, by such a document: a row a stage, the one that took the processor longest
// first; its processor time is told per whole frame. Throws InputError that begins with `name` if
// the text is no such document.
Table stage_table(const std::string& json, const std::string& name);

}  // namespace samewhere::report
