#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <samewhere/core/source.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/report/record.hpp>
#include <samewhere/run/mapped_slam.hpp>
#include <samewhere/run/watcher.hpp>

namespace samewhere::run {

// What a run over a whole source produced, ready for report/ to write.
struct RunOutcome {
  report::RunRecord record;
  // Recognition alone: the best match of each query with its score, and those accepted.
  std::vector<report::ScoredPair> matches;
  std::vector<report::ScoredPair> accepted;
  // Why the map file lacks what came last; everything else is as it should be.
  std::optional<std::string> map_error;
};

// SLAM over a source, read one frame ahead in its own thread, with a progress line on stderr. Of a
// camera (is_live), or a recording that is played (input.realtime), always the newest frame; how
// many were dropped is a figure. Stops early at Ctrl-C. Throws InputError if the source lacks the
// camera file that SLAM needs, or if the known map cannot be used or was made with other settings.
// is_quiet: without the progress line. `watcher`, if any, outlives the run.
RunOutcome run_slam(std::unique_ptr<core::Source> source, const pipeline::Config& config,
                    const MapPlan& plan = {}, bool is_quiet = false, Watcher* watcher = nullptr);

// Recognition alone: every frame is a query against all older ones. Needs neither depth nor camera.
// `begin`, if any, is called once, when there is a first frame. is_quiet: without the progress
// line. `watcher`, if any, outlives the run.
RunOutcome run_recognition(std::unique_ptr<core::Source> source, const pipeline::Config& config,
                           std::function<void()> begin = {}, bool is_quiet = false,
                           Watcher* watcher = nullptr);

}  // namespace samewhere::run
