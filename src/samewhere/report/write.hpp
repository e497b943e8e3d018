#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <samewhere/report/loops.hpp>
#include <samewhere/report/record.hpp>

namespace samewhere::report {

// Writes trajectory.tum, odometry.tum (before any correction), frames.csv, loops.json, map.ply,
// config.yaml, timing.json and report.html into an existing folder. Each file is written whole or
// not at all, most important first, for a disk that is nearly full. Returns one line for each file
// that could not be written, with the reason.
std::vector<std::string> write_run(const RunRecord& record, const std::filesystem::path& folder);

// Recognition alone: matches.txt (the best match of each query, accepted or not), accepted.txt,
// loops.json, config.yaml, timing.json and report.html. The record needs no frames; the
// page then shows no trajectory.
std::vector<std::string> write_recognition(const RunRecord& record,
                                           const std::vector<ScoredPair>& matches,
                                           const std::vector<ScoredPair>& accepted,
                                           const std::filesystem::path& folder);

}  // namespace samewhere::report
