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
  // With a pose that is not provisional. nullptr: no frame of the session has one.
  const core::FramePose* last_confirmed() const;
  // The frame before it, if it has such a pose, too; else nullptr.
  const core::FramePose* before(const core::FramePose& frame) const;

  void add(const core::FramePose& frame) { frames_.push_back(frame); }
  // The map is discarded: no frame has a pose, and all are to be sent again.
  void discard_poses();

  // The newest provisional frames: their poses are those of a confirmed relocalization, ...
  void confirm_provisional(int weak_inliers);
  // ... they lose their poses, ...
  void take_back_provisional();
  // ... or their poses in the world change. `place_again`: a pose of before.
  template <class PlaceAgain>
  void move_provisional(const PlaceAgain& place_again) {
    for_each_provisional([&](core::FramePose& frame) { frame = place_again(frame); });
  }

  std::size_t num_unsent() const { return frames_.size() - num_sent_; }
  std::vector<core::FramePose> take_unsent();

 private:
  // Of the last relocalization; lost frames between them are left out.
  template <class Visit>
  void for_each_provisional(const Visit& visit) {
    for (std::size_t i = frames_.size(); i-- > num_sent_ && !is_confirmed(frames_[i]);)
      if (frames_[i].status == core::FrameStatus::kProvisional) visit(frames_[i]);
  }

  std::uint16_t session_ = 0;
  std::vector<core::FramePose> frames_;
  std::size_t num_sent_ = 0;
};

}  // namespace samewhere::pipeline
