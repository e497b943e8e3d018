#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include <samewhere/core/progress.hpp>
#include <samewhere/core/source.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::run {

// Some frames of the source of a finished run, read once more, with a progress line on stderr.
class SourceFrames {
 public:
  // `config` is that of the run; `positions` of the frames in the source. Throws InputError if the
  // source cannot be opened, or is a live camera.
  SourceFrames(const pipeline::Config& config, std::set<std::uint64_t> positions);

  const core::SourceInfo& info() const { return info_; }

  // The next of these frames, nothing after the last. Throws InputError if the source ends before,
  // Interrupted after Ctrl-C.
  std::optional<core::Frame> next();

 private:
  [[noreturn]] void complain_about_length() const;

  std::string name_;
  std::set<std::uint64_t> positions_;
  std::unique_ptr<core::Source> source_;
  core::SourceInfo info_;
  core::Progress progress_;
  std::size_t num_given_ = 0;
};

}  // namespace samewhere::run
