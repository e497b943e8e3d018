#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/pipeline/loop_detector.hpp>
#include <samewhere/run/run.hpp>

namespace samewhere::run {

// A frame after the first step: what the later ones need of it.
struct DescribedFrame {
  core::Descriptor descriptor;
  features::View view;
  std::string thumbnail;  // JPEG
  core::Frame frame;      // for a watcher; without one empty
};

// And after the second.
struct SearchedFrame {
  DescribedFrame described;
  std::vector<retrieve::FoundView> found;
};

using NextFrame = std::function<std::optional<core::Frame>()>;

// The parallel structure of the published method: preprocessing and description | preliminary
// match | exact similarity (and, beyond it, verification). Each step gets every frame, in order.
struct RecognitionSteps {
  std::function<DescribedFrame(const core::Frame&)> describe;
  std::function<SearchedFrame(DescribedFrame)> search;
  std::function<void(const SearchedFrame&)> verify;
};

// Until `next` gives nothing. What `next` or a step throws comes out.
void run_in_turn(const NextFrame& next, const RecognitionSteps& steps);
// The same with `next` and `describe` in one thread, `search` in another and `verify` in the
// caller's, a few frames behind each other. The steps share nothing but what they hand on.
void run_in_threads(const NextFrame& next, const RecognitionSteps& steps);

// The config of recognition alone: no loop needs a relative pose, since there is no map that could
// use one.
pipeline::Config without_map(pipeline::Config config);

// Recognition alone: which frames show a place seen before?
class Recognition {
 public:
  // The window is resolved into frames, and the config is that of without_map().
  // `watcher`, if any, is told of each verified frame.
  explicit Recognition(const pipeline::Config& config, Watcher* watcher = nullptr);

  // Point into this object.
  RecognitionSteps steps();

  // What was found so far, by which describer, with the time of each step and of all of a frame's
  // steps together.
  // Nothing runs any more.
  void report_to(RunOutcome& outcome) &&;

 private:
  DescribedFrame describe(const core::Frame& frame);
  SearchedFrame search(DescribedFrame described);
  void verify(const SearchedFrame& searched);
  void keep(const core::Ledger& rows);
  void tell_watcher(const DescribedFrame& described, const core::Ledger& rows);
  void find_best_of_queries();

  pipeline::Config config_;
  pipeline::LoopDetector detector_;
  Watcher* watcher_;
  // one for each step, since each may have its own thread
  core::Timings describe_timings_;
  core::Timings search_timings_;
  core::Timings verify_timings_;
  // of verify()
  RunOutcome found_;
  std::set<core::FrameId> told_pictures_;
};

}  // namespace samewhere::run
