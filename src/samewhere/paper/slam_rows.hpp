#pragma once

#include <optional>
#include <string>
#include <vector>

#include <samewhere/paper/results.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::paper {

// How SLAM closes loops in Tables 6 to 8: not at all, by the published method, by bag of words and
// geometry alone as in ORB-SLAM2, as shipped. The rest is profile `default`, but for `paper`.
const std::vector<ComparedMethod>& slam_configurations();

// The profile of a configuration with the source of `base` and this seed. The window is the
// profile's, not that of the recognition protocol.
pipeline::Config slam_config(const pipeline::Config& base, const std::string& configuration,
                             int seed);

// Why SLAM cannot be run or not be scored on this source: it has no calibration, or no true
// trajectory. Throws InputError if it cannot be opened.
std::optional<std::string> why_no_slam(const pipeline::Config& config);

// One run. `name`: of the recording. Nothing after Ctrl-C. Throws InputError if the source fails.
std::optional<SlamRow> run_slam_once(const pipeline::Config& config, const std::string& name,
                                     const std::string& configuration);

}  // namespace samewhere::paper
