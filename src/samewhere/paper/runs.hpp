#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/core/timing.hpp>
#include <samewhere/evaluate/precision_recall.hpp>
#include <samewhere/paper/described_recording.hpp>
#include <samewhere/retrieve/config.hpp>

namespace samewhere::paper {

// How often the searches of the published tables are repeated.
struct PaperPlan {
  std::vector<int> num_draws{10, 20, 30, 40, 50, 60, 70};  // L
  int num_seeds = 5;                                       // 0, 1, ...
};

// Loops accepted as the published Table 6 counts them.
struct PausedLoops {
  evaluate::AcceptedCounts counts;
  std::optional<int> num_impostors;  // of the wrong ones; only if the truth names any
};

// One search of every view among the older ones.
struct PaperRun {
  retrieve::Search search = retrieve::Search::kSampled;
  int num_draws = 0;  // of a sampled search
  int seed = 0;
  evaluate::PrecisionRecall result;
  PausedLoops loops;
  std::vector<double> search_ms;            // one a frame
  std::vector<double> exact_similarity_ms;  // one a frame
};

// All searches of one recording with one describer.
struct PaperBlock {
  std::string recording;
  std::string describer;
  std::uint64_t describer_checksum = 0;
  int window_frames = 0;
  double min_similarity = 0.0;    // of the loops
  int pause_frames = 0;           // of the loops
  std::vector<int> timed_frames;  // whose description was timed; as in DescribedRecording
  std::vector<double> describe_ms;
  // By number of draws, then seed; then with every queue, which is what more draws tend to; at the
  // end the exact search, which knows no threshold and ranks by NCC.
  std::vector<PaperRun> runs;
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
// describer, with a progress line on stderr. Precision and recall without the pause, loops with it
// (docs/evaluation.md). Nothing after Ctrl-C.
std::optional<PaperBlock> run_paper_plan(const DescribedRecording& recording,
                                         const DescribedViews& views,
                                         const pipeline::Config& config, const PaperPlan& plan);

}  // namespace samewhere::paper
