#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <samewhere/core/frame_pose.hpp>

namespace samewhere::pipeline {

// The pose, or the lack of one, of each frame of a session, and how many of them were sent to
// mapping, which saves them. Frames are numbered from 0.
class FrameLog {
 public:
  explicit FrameLog(std::uint16_t session);

  std::uint16_t session() const { return session_; }
  core::FrameId next_id() const { return core::FrameId(frames_.size(), session_); }
  std::size_t size() const { return frames_.size(); }
  const std::vector<core::FramePose>& frames() const { return frames_; }
  const core::FramePose& newest() const { return frames_.back(); }
  core::FramePose& newest() { return frames_.back(); }
  core::FramePose& at(core::FrameId frame) { return frames_.at(frame.index()); }
  // nullptr: no frame of the session has a pose.
  const core::FramePose* last_measured() const;

  void add(const core::FramePose& frame) { frames_.push_back(frame); }
  // The map is discarded: no frame has a pose, and all are to be sent again.
  void discard_poses();

  std::size_t num_unsent() const { return frames_.size() - num_sent_; }
  std::vector<core::FramePose> take_unsent();

 private:
  std::uint16_t session_ = 0;
  std::vector<core::FramePose> frames_;
  std::size_t num_sent_ = 0;
};

}  // namespace samewhere::pipeline
