#include <utility>

#include <samewhere/paper/method_rows.hpp>
#include <samewhere/paper/methods/methods.hpp>
#include <samewhere/paper/runs.hpp>

namespace samewhere::paper {

TimedMethod::TimedMethod(std::string name, const pipeline::Config& config)
    : name_(std::move(name)),
      window_frames_(config.retrieve.window_frames),
      method_(make_method(name_, config)) {}

// Processor time: images are read and rendered by other threads meanwhile.
void TimedMethod::see(const core::Frame& frame) {
  const double start_ms = core::thread_processor_ms();
  method_->see(frame);
  processor_ms_.push_back(core::thread_processor_ms() - start_ms);
}

RecognitionRow TimedMethod::row(const std::string& recording, const core::Truth& truth) {
  const Findings findings = method_->findings();
  return {.recording = recording,
          .window_frames = window_frames_,
          .method = name_,
          .search = SearchKind::kOwn,
          .result = evaluate::precision_recall(*truth.places, findings.matches, window_frames_),
          .loops = count_loops(findings.accepted, truth, window_frames_),
          .ms = {{kTogether, core::summarize(processor_ms_)}}};
}

}  // namespace samewhere::paper
