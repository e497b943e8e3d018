#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/report/figure.hpp>
#include <samewhere/run/frame_feed.hpp>

namespace samewhere::run {

FrameFeed::FrameFeed(core::Source& source, report::RunRecord& record, bool is_quiet)
    : source_(source), record_(record), progress_("frames", source.info().num_frames, is_quiet) {}

std::optional<core::Frame> FrameFeed::next() {
  if (num_given_ > 0) progress_.update(num_given_ + num_dropped_, note_);
  record_.is_interrupted = core::is_interrupted();
  if (record_.is_interrupted) return std::nullopt;
  try {
    const core::ScopedTimer timer(timings_, report::kWaitForInputStage);
    ++num_given_;
    note_memory();
    std::optional<core::Frame> frame = source_.next();
    if (frame) num_dropped_ += frame->num_dropped_before;
    // or while it was waited for
    if (!frame) record_.is_interrupted = core::is_interrupted();
    return frame;
  } catch (const core::InputError& error) {
    record_.input_error = error.what();
  } catch (const core::Interrupted&) {
    record_.is_interrupted = true;
  }
  return std::nullopt;
}

void FrameFeed::report() const {
  record_.timings.add(timings_);
  if (source_.info().is_live)
    record_.figures.push_back(report::figure("frames dropped", "{}", num_dropped_));
}

// About 300 samples of ten minutes.
void FrameFeed::note_memory() {
  constexpr int kFrames = 50;
  if (num_given_ % kFrames == 1)
    record_.memory.push_back({num_given_ - 1, core::resident_memory_mib()});
}

}  // namespace samewhere::run
