#pragma once

#include <optional>
#include <string>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/core/source.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/report/record.hpp>

namespace samewhere::run {

// The frames of a source until its end, an error or Ctrl-C, with a progress line on stderr. The
// record tells which.
class FrameFeed {
 public:
  // `source` and `record` outlive the feed. is_quiet: without the progress line.
  FrameFeed(core::Source& source, report::RunRecord& record, bool is_quiet);

  std::optional<core::Frame> next();

  // What the progress line tells beside the frames.
  void note(std::string text) { note_ = std::move(text); }

  // When all frames were given: how long they took to come, and what was dropped meanwhile.
  void report() const;

 private:
  void note_memory();

  core::Source& source_;
  report::RunRecord& record_;
  core::Timings timings_;
  core::Progress progress_;
  std::string note_;
  int num_given_ = 0;
  int num_dropped_ = 0;
};

}  // namespace samewhere::run
