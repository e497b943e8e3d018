#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <samewhere/report/loops.hpp>
#include <samewhere/report/record.hpp>

namespace samewhere::report {

// Writes trajectory.tum, odometry.tum (before any correction), frames.csv, loops.json, map.ply,
// config.yaml, timing.json and report.html into a folder that exists. Each file whole or not at
// all, in the order of their worth: on a disk that is nearly full the first ones fit. Returns what
// could not be written and why, a line for each.
std::vector<std::string> write_run(const RunRecord& record, const std::filesystem::path& folder);

// Recognition alone: matches.txt (the best match of each query, accepted or not), accepted.txt,
// loops.json, config.yaml, timing.json and report.html. The record needs no frames: their poses
// were not asked for, and the page then does not speak of them.
std::vector<std::string> write_recognition(const RunRecord& record,
                                           const std::vector<ScoredPair>& matches,
                                           const std::vector<ScoredPair>& accepted,
                                           const std::filesystem::path& folder);

}  // namespace samewhere::report
