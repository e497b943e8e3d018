#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <vector>

#include <samewhere/core/timing.hpp>
#include <samewhere/pipeline/messages.hpp>

namespace samewhere::pipeline {

// Tracking's end of the link to mapping. At most one keyframe is in progress: sent, and not yet
// visible to tracking. Its map is due `visible_after_frames` frames later; earlier if tracking
// needs it and waits.
class MappingExchange {
 public:
  // `link` outlives this. `num_keyframes`: of a known map.
  MappingExchange(MappingLink& link, int visible_after_frames, std::uint64_t num_keyframes);
  MappingExchange(const MappingExchange&) = delete;
  MappingExchange& operator=(const MappingExchange&) = delete;

  // Before the first message: answers are received when they are there, not when they are due, so
  // that only initialize() waits. The stages have threads; the results are not repeatable.
  void never_wait() { never_waits_ = true; }

  // The map that begins with a StartMap or StartMapByMotion; an earlier one is discarded. Waits.
  scene::MapVersion initialize(ToMapping start);
  // Becomes next_keyframe(); its frame is the last one of `frames`.
  void insert(scene::TrackedView tracked, const cv::Mat& image,
              std::vector<core::FramePose> frames);
  bool is_keyframe_in_progress() const { return in_progress_.has_value(); }
  // Whether tracking may receive the keyframe in progress before it is due, and insert one.
  bool may_receive() const { return !never_waits_ || link_.is_ready(); }
  bool may_insert() const { return !in_progress_ && (!places_due_at_frame_ || may_receive()); }
  bool is_due(std::size_t num_frames) const;
  struct VisibleKeyframe {
    core::KeyframeId id;
    scene::MapVersion map;  // with the keyframe
  };
  // The keyframe in progress. Waits.
  VisibleKeyframe receive();
  // Places of the whole map that the view may show. Waits.
  MapAnswer find_places(const features::View& view, const cv::Mat& image);
  // The same, answered some frames later by receive_places(); a question that waits drops the
  // answer.
  void ask_places(const features::View& view, const cv::Mat& image);
  bool are_places_asked() const { return places_due_at_frame_.has_value(); }
  bool are_places_due(std::size_t num_frames) const;
  // Whether places are asked for and received later, of every view.
  bool waits_for_places() const { return !never_waits_; }
  MapAnswer receive_places();  // waits
  // Frames without a keyframe.
  void save(std::vector<core::FramePose> frames);
  void finish(std::vector<core::FramePose> frames);

  // The frame is a keyframe of the map that begins.
  void note_keyframe(core::FrameId frame) { keyframes_.insert(frame); }
  bool is_keyframe(core::FrameId frame) const { return keyframes_.contains(frame); }
  core::KeyframeId next_keyframe() const { return core::KeyframeId(num_keyframes_); }
  // All that were sent, or known before; those of the current map.
  std::uint64_t num_keyframes() const { return num_keyframes_; }
  std::uint64_t num_keyframes_of_map() const { return num_keyframes_ - num_discarded_; }

  // Verdicts on loop candidates that came with the answers, since forget_rows().
  const core::Ledger& rows() const { return rows_; }
  void forget_rows() { rows_.clear(); }

  const core::Timings& timings() const { return timings_; }

 private:
  struct InProgress {
    core::KeyframeId id;
    std::size_t due_at_frame = 0;  // position
  };

  MapAnswer wait();
  void drop_places();

  MappingLink& link_;
  std::size_t visible_after_frames_ = 0;
  bool never_waits_ = false;
  core::Ledger rows_;
  core::Timings timings_;
  std::uint64_t num_keyframes_ = 0;
  std::uint64_t num_discarded_ = 0;
  std::set<core::FrameId> keyframes_;  // frames of the current map
  std::optional<InProgress> in_progress_;
  std::optional<std::size_t> places_due_at_frame_;  // position
};

}  // namespace samewhere::pipeline
