#pragma once

#include <optional>
#include <vector>

#include <samewhere/core/timing.hpp>
#include <samewhere/evaluate/precision_recall.hpp>
#include <samewhere/paper/described_recording.hpp>
#include <samewhere/paper/rows.hpp>

namespace samewhere::paper {

// How often the searches of the published tables are repeated.
struct PaperPlan {
  std::vector<int> num_draws{10, 20, 30, 40, 50, 60, 70};  // L
  int num_seeds = 5;                                       // 0, 1, ...
};

// The most similar of each view's candidates by exact similarity (NCC), for queries that have any:
// the search that config.retrieve names, by config.retrieve and config.seed. The times of both
// steps go into `timings`, one a frame, as "search" and "exact similarity".
std::vector<evaluate::Match> best_matches(const std::vector<core::Descriptor>& views,
                                          const pipeline::Config& config, core::Timings& timings);

// Of the best matches those that the published detector accepts: more similar than
// config.verify.min_similarity, and not within config.verify.pause_frames after the last one.
std::vector<evaluate::Match> accepted_with_pause(const std::vector<evaluate::Match>& matches,
                                                 const verify::Config& config);

// Every search of the plan, and the two without chance, on a described recording's views by one
// describer, with a progress line on stderr: rows by number of draws, then seed; then with every
// queue, which is what more draws tend to; at the end the exact search, which knows no threshold
// and ranks by NCC. Precision and recall without the pause, loops with it (docs/evaluation.md).
// Nothing after Ctrl-C.
std::optional<std::vector<RecognitionRow>> run_searches(const DescribedRecording& recording,
                                                        const DescribedViews& views,
                                                        const pipeline::Config& config,
                                                        const PaperPlan& plan);

// The accepted loops by the truth.
RecognitionLoops count_loops(const std::vector<evaluate::Match>& accepted, const core::Truth& truth,
                             int window_frames);

}  // namespace samewhere::paper
