#pragma once

#include <memory>
#include <string>
#include <vector>

#include <samewhere/core/source.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/report/record.hpp>

namespace samewhere::pipeline {

// What a run over a whole source produced, ready for report/ to write.
struct RunOutcome {
  report::RunRecord record;
  // Recognition alone: the best match of each query with its score, and those accepted.
  std::vector<report::ScoredPair> matches;
  std::vector<report::ScoredPair> accepted;
};

// SLAM over a source, read one frame ahead in its own thread, with a progress line on stderr. Stops
// early at Ctrl-C. Throws InputError if the source lacks the depth or the camera that SLAM needs.
RunOutcome run_slam(std::unique_ptr<core::Source> source, const Config& config);

// Recognition alone: every frame is a query against all older ones. Needs neither depth nor camera.
RunOutcome run_recognition(std::unique_ptr<core::Source> source, const Config& config);

}  // namespace samewhere::pipeline
