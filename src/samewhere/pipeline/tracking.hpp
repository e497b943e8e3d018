#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/frame_pose.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/map/mapper.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/messages.hpp>
#include <samewhere/pipeline/passing_things.hpp>
#include <samewhere/pipeline/pose_hypotheses.hpp>
#include <samewhere/scene/local_map.hpp>
#include <samewhere/scene/map_file.hpp>
#include <samewhere/track/scale_drift_detector.hpp>
#include <samewhere/track/starter.hpp>
#include <samewhere/track/tracker.hpp>

namespace samewhere::pipeline {

// Where the depth of landmarks comes from. kMotion: one camera; the map starts from two views, and
// its scale is free.
enum class DepthFrom { kSensor, kMotion };

// The first stage: where am I, and is this view worth keeping? Owns the pose of every frame. It
// sees the map as mapping answered last; a new keyframe shows in it `map.visible_after_frames`
// frames later, or at once if tracking is in trouble without it. At most one keyframe is under way.
class Tracking {
 public:
  // `mapping` outlives this.
  Tracking(const Config& config, DepthFrom depth_from, MappingLink& mapping);
  // In a map that is there: lost until a place is recognised. Fixed: no keyframe is added.
  Tracking(const Config& config, const scene::StoredMap& known, bool is_map_fixed,
           MappingLink& mapping);

  // Frames are numbered from 0, in session(). Their pictures are shared: nobody writes to them.
  std::uint16_t session() const { return session_; }
  void feed(const core::Frame& frame);
  void finish();

  // One entry per frame fed.
  const std::vector<core::FramePose>& frames() const { return frames_; }
  const core::Timings& timings() const { return timings_; }
  // Why the views tried last did not start a map.
  std::string why_not_started() const;
  // Where the scale of a map without depth is suspected to have changed, in the order of time.
  const std::vector<track::ScaleDoubt>& scale_doubts() const { return scale_doubts_; }
  // How often the map was given up for a new one, with all poses found in it.
  int num_starts_given_up() const { return num_starts_given_up_; }

 private:
  features::View extract(const core::Frame& frame);
  // Where am I? Nothing: lost.
  std::optional<map::TrackedView> locate(const core::Frame& frame, const features::View& view);
  std::optional<map::TrackedView> locate_in_map(const core::Frame& frame,
                                                const features::View& view);
  // Where few features hold a pose or none, in the dark or before bare walls, the depth picture
  // may: by what moved since the last frame's.
  std::optional<map::TrackedView> held_by_depth(const core::Frame& frame,
                                                const features::View& view);
  std::optional<map::TrackedView> track_from_last(const features::View& view);
  // The same again, if the map has got nearer; the better of both.
  void try_again(const features::View& view, std::optional<map::TrackedView>& best);
  // Lost: which place of the whole map is this?
  std::optional<map::TrackedView> relocalise(const core::Frame& frame, const features::View& view);
  // Whether one can have got there since the last pose. What lies beyond is another place that
  // looks like this one.
  bool is_within_reach(const core::FramePose& pose) const;
  const core::FramePose* last_measured() const;  // nullptr: none in this session
  Proof proof_to_resume(double stamp_s) const;
  // The reference goes along with the camera: it is the keyframe that shows most of what the view
  // shows, however old, and the local map is what lies around it.
  void follow(map::TrackedView& tracked);
  core::FramePose relative_to(core::KeyframeId reference, core::FramePose pose) const;
  // As odometry knows it: relative to the newest keyframe if the way from there to its reference
  // takes a loop. What is kept of a frame rests on no loop, or it would stay behind if the loop
  // were withdrawn, and a keyframe would hold the loop as if it were odometry.
  core::FramePose by_odometry(const core::FramePose& pose);
  core::Rigid3 guessed_pose() const;
  void remember(const map::TrackedView& tracked);
  // What a frame without a pose is: lost, or waiting for the map to begin.
  core::FrameStatus status_without_pose(const features::View& view) const;
  // Without depth: a pose whose scale is suspected to have changed is weak, and noted.
  void doubt_scale(map::TrackedView& tracked);

  // The map begins. Nothing: not yet.
  std::optional<map::TrackedView> start(const core::Frame& frame, const features::View& view);
  // One camera: once a second view has parallax against an earlier one.
  std::optional<map::TrackedView> start_by_motion(const core::Frame& frame,
                                                  const features::View& view);
  // Whether who is lost in this map may give it up for a new one.
  bool is_start_doubtful(double stamp_s) const;
  // He does; with depth not at once: what hides the view may pass.
  std::optional<map::TrackedView> start_anew(const core::Frame& frame, const features::View& view);
  // No frame so far has a pose.
  void give_up_poses();
  // Frames that were passed while the start was awaited: found in the map that it made.
  void locate_passed(const std::vector<features::View>& views);
  void begin_tracking(const features::View& view, int num_landmarks);

  bool can_promote_last() const;
  // The frame that was fed last becomes a keyframe. An empty image: its own is gone.
  void keep(const map::TrackedView& tracked, const cv::Mat& image);
  // The map that shows the keyframe under way; waits for it.
  void see_kept();
  MapAnswer wait_for_mapping();
  void look_around(core::KeyframeId reference);

  bool is_kept(const map::TrackedView& tracked) const;
  core::Rigid3 world_from(const core::FramePose& pose) const;
  map::TrackedView tracked_view(const features::View& view, const track::Track& track) const;
  std::vector<core::FramePose> unsent_frames();

  Config config_;
  core::Timings timings_;
  track::Tracker tracker_;
  track::Tracker lost_tracker_;
  PlaceFinder place_finder_;
  PassingThings passing_;
  std::optional<track::Starter> starter_;  // one camera
  int num_features_ = 0;                   // of the last view that might have started
  int num_with_depth_ = 0;                 // of these
  track::ScaleWatch scale_watch_;
  std::vector<track::ScaleDoubt> scale_doubts_;
  MappingLink& mapping_;

  std::uint16_t session_ = 0;
  bool is_map_fixed_ = false;
  scene::MapVersion map_;  // as it is visible
  scene::LocalMap local_map_;
  std::uint64_t num_keyframes_ = 0;  // sent to mapping, or there before
  std::uint64_t num_given_up_ = 0;   // of these, when the map began anew
  int num_starts_given_up_ = 0;
  double started_at_s_ = 0.0;         // stamp of the view that the map began with
  std::uint64_t first_followed_ = 0;  // tracking was not lost since this one
  struct Way {
    std::uint64_t map_number = 0;
    core::KeyframeId from;
    core::KeyframeId to;
    bool operator==(const Way&) const = default;
  };
  std::optional<std::pair<Way, bool>> last_way_;  // whether it takes a loop
  std::map<core::FrameId, core::KeyframeId> keyframe_of_;
  struct UnderWay {
    core::KeyframeId keyframe;
    std::size_t due_at_frame = 0;  // position
  };
  std::optional<UnderWay> under_way_;

  std::vector<core::FramePose> frames_;
  std::size_t num_sent_frames_ = 0;
  std::optional<map::TrackedView> last_;  // the frame before, if it was located
  int num_lost_ = 0;                      // frames since then
  std::optional<cv::Mat> last_depth_m_;   // of that frame
  core::Rigid3 last_from_next_;           // motion model: the last step once more
};

}  // namespace samewhere::pipeline
