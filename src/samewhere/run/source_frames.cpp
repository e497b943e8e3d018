#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/input/prefetch.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/run/source_frames.hpp>

namespace samewhere::run {
namespace {

std::unique_ptr<core::Source> open_recording(const pipeline::Config& config) {
  std::unique_ptr<core::Source> source = open_source(config);
  if (!source->info().is_live) return input::prefetched(std::move(source));
  throw core::InputError(config.source +
                         ": is a live camera, whose pictures are gone; expected a recording");
}

}  // namespace

SourceFrames::SourceFrames(const pipeline::Config& config, std::set<std::uint64_t> positions)
    : name_(config.source),
      positions_(std::move(positions)),
      source_(open_recording(config)),
      info_(source_->info()),
      progress_("frames", info_.num_frames) {}

std::optional<core::Frame> SourceFrames::next() {
  while (num_given_ < positions_.size()) {
    core::stop_if_interrupted();
    std::optional<core::Frame> frame = source_->next();
    if (!frame) complain_about_length();
    progress_.update(static_cast<int>(frame->id.index()) + 1);
    if (!positions_.contains(frame->id.index())) continue;
    ++num_given_;
    return frame;
  }
  return std::nullopt;
}

void SourceFrames::complain_about_length() const {
  throw core::InputError(
      fmt::format("{}: ended before frame {}, a keyframe of the run: the source has changed since "
                  "the run",
                  name_, *positions_.rbegin()));
}

}  // namespace samewhere::run
