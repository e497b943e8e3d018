#pragma once

#include <optional>
#include <vector>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/frame_pose.hpp>
#include <samewhere/core/ledger.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/core/truth.hpp>
#include <samewhere/map/mapper.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/loop_detector.hpp>
#include <samewhere/scene/local_map.hpp>
#include <samewhere/track/tracker.hpp>

namespace samewhere::pipeline {

// The whole system on one thread: frames in, poses, a map and a ledger of judged loops out.
class Slam {
 public:
  explicit Slam(const Config& config);
  Slam(const Slam&) = delete;
  Slam& operator=(const Slam&) = delete;

  // Frames ascend in id and stamp.
  void feed(const core::Frame& frame);

  // One entry per frame fed.
  const std::vector<core::FramePose>& frames() const { return frames_; }
  const scene::MapVersion& map() const { return map_; }
  const core::Ledger& ledger() const { return ledger_; }
  bool is_keyframe(core::FrameId frame) const { return keyframe_of_.contains(frame); }
  std::uint64_t describer_checksum() const { return detector_.describer_checksum(); }
  core::Timings& timings() { return timings_; }

 private:
  // Where am I? Nothing: lost.
  std::optional<map::TrackedView> locate(const features::View& view);
  std::optional<map::TrackedView> locate_in_map(const features::View& view);
  std::optional<map::TrackedView> track_from_last(const features::View& view);
  core::Rigid3 guessed_pose() const;
  // The view becomes the reference that the next frames are tracked from.
  void keep(const map::TrackedView& tracked);
  void start(const features::View& view);
  // Have I been here before, and is it really the same place? Then the past must be corrected.
  void look_for_loops(const core::Frame& frame, const features::View& view);
  void correct(const std::vector<core::LedgerRow>& rows);

  map::TrackedView tracked_view(const features::View& view, const track::Track& track) const;
  void apply(const scene::Edit& edit);
  void remember(const map::TrackedView& tracked);

  Config config_;
  core::Timings timings_;
  track::Tracker tracker_;
  LoopDetector detector_;

  scene::MapVersion map_;
  scene::LocalMap local_map_;
  core::Ledger ledger_;
  std::vector<core::FramePose> frames_;
  std::map<core::FrameId, core::KeyframeId> keyframe_of_;

  std::optional<map::TrackedView> last_;  // the frame before, if it was located
  core::Rigid3 last_from_next_;           // motion model: the last step once more
};

// Pose of camera 0 at each measured frame, after all corrections: derived from the reference
// keyframes.
core::Trajectory trajectory_of(const scene::MapVersion& map,
                               const std::vector<core::FramePose>& frames);
// The same as if no loop had been closed.
core::Trajectory odometry_of(const scene::MapVersion& map,
                             const std::vector<core::FramePose>& frames);

}  // namespace samewhere::pipeline
