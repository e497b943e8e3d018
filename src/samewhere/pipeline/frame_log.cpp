#include <algorithm>
#include <utility>

#include <samewhere/pipeline/frame_log.hpp>

namespace samewhere::pipeline {
namespace {

// An hour at 30 Hz, as address space: memory is taken as frames come. A vector that grows by
// copying leaves as much again behind.
constexpr std::size_t kReservedFrames = 108000;

}  // namespace

FrameLog::FrameLog(std::uint16_t session) : session_(session) { frames_.reserve(kReservedFrames); }

const core::FramePose* FrameLog::last_confirmed() const {
  const auto last = std::find_if(frames_.rbegin(), frames_.rend(), core::is_confirmed);
  return last == frames_.rend() ? nullptr : &*last;
}

const core::FramePose* FrameLog::before(const core::FramePose& frame) const {
  const std::size_t index = frame.frame.index();
  return index > 0 && is_confirmed(frames_.at(index - 1)) ? &frames_[index - 1] : nullptr;
}

void FrameLog::confirm_provisional(int weak_inliers) {
  for_each_provisional([&](core::FramePose& frame) {
    frame.status =
        frame.num_inliers < weak_inliers ? core::FrameStatus::kWeak : core::FrameStatus::kTracking;
  });
}

void FrameLog::take_back_provisional() {
  for_each_provisional([](core::FramePose& frame) {
    frame = {.frame = frame.frame, .stamp_s = frame.stamp_s, .status = core::FrameStatus::kLost};
  });
}

void FrameLog::discard_poses() {
  for (auto& frame : frames_) {
    const core::FrameStatus status =
        is_waiting(frame.status) ? frame.status : core::FrameStatus::kLost;
    frame = {.frame = frame.frame, .stamp_s = frame.stamp_s, .status = status};
  }
  num_sent_ = 0;
}

std::vector<core::FramePose> FrameLog::take_unsent() {
  const auto first = static_cast<std::ptrdiff_t>(std::exchange(num_sent_, frames_.size()));
  return {frames_.begin() + first, frames_.end()};
}

}  // namespace samewhere::pipeline
