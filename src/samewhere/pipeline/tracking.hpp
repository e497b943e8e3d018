#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/frame_pose.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/frame_log.hpp>
#include <samewhere/pipeline/initialization.hpp>
#include <samewhere/pipeline/mapping_exchange.hpp>
#include <samewhere/pipeline/odometry_tracking.hpp>
#include <samewhere/pipeline/passing_things.hpp>
#include <samewhere/pipeline/relocalization.hpp>
#include <samewhere/pipeline/session.hpp>
#include <samewhere/pipeline/visible_map.hpp>
#include <samewhere/scene/map_file.hpp>
#include <samewhere/scene/tracked_view.hpp>
#include <samewhere/track/scale_drift_detector.hpp>
#include <samewhere/track/tracker.hpp>

namespace samewhere::pipeline {

// The frame that was fed last, in the map that it was tracked in.
struct NewestFrame {
  std::optional<core::FramePose> pose;  // none: lost
  // Of the body now in that at the frame before; none: one of both has no pose.
  std::optional<core::Rigid3> last_from_newest;
  std::shared_ptr<const features::Features> features;
  std::vector<int> tracked_features;  // that show a landmark of the map
};

// The first stage: poses of the frames, and which of them become keyframes. It uses the map as
// mapping answered last. A new keyframe is visible `map.visible_after_frames` frames later, or at
// once if tracking is weak without it.
class Tracking {
 public:
  // `mapping` outlives this.
  Tracking(const Config& config, DepthFrom depth_from, MappingLink& mapping);
  // In a known map: lost until it is relocalized. Fixed: no keyframe is inserted.
  Tracking(const Config& config, const scene::StoredMap& known, bool is_map_fixed,
           MappingLink& mapping);
  Tracking(const Tracking&) = delete;
  Tracking& operator=(const Tracking&) = delete;

  // Before the first frame: poses are those of this odometry; in a known map it predicts them.
  void follow(std::shared_ptr<const OdometryPath> odometry);

  // Frames are numbered from 0, in session(). Their images are shared and must not be written to.
  std::uint16_t session() const { return log_.session(); }
  void feed(const core::Frame& frame);
  void finish();

  // One entry per frame fed.
  const std::vector<core::FramePose>& frames() const { return log_.frames(); }
  // The map that the newest frame was tracked in.
  const scene::MapVersion& visible_map() const { return map_.version(); }
  const NewestFrame& newest() const { return newest_; }
  // Verdicts that mapping told with the newest frame.
  const core::Ledger& newest_rows() const { return mapping_.rows(); }

  // Fixed: no keyframe is inserted, and the map is not discarded.
  void set_map_fixed(bool is_fixed) { is_map_fixed_ = is_fixed; }
  // Before the first frame: see Slam::never_wait().
  void never_wait() { mapping_.never_wait(); }

  core::Timings timings() const;
  SessionPhase phase() const { return state_.phase(); }
  // Why the last views that were tried did not begin a map, in words.
  std::string why_not_initialized() const { return initialization_.why_not(); }
  // Monocular: where the scale is suspected to have drifted, in the order of time.
  const std::vector<track::ScaleDriftInterval>& scale_drift() const { return scale_drift_; }
  // Whether images agree with odometry from a file. Zeros without one.
  ImageAgreement odometry_agreement() const {
    return odometry_ ? odometry_->agreement() : ImageAgreement{};
  }
  // How the relocalizations of the session ended.
  const RelocalizationCounts& relocalizations() const { return relocalization_.counts(); }
  // How often the map, with all its poses, was discarded for a new one.
  int num_reinitializations() const { return state_.num_reinitializations(); }

 private:
  using MaybeTracked = std::optional<scene::TrackedView>;

  Tracking(const Config& config, SessionState state, scene::MapVersion map, std::uint16_t session,
           MappingLink& mapping);

  // A step, in this order.
  void exchange_with_mapping();
  features::View extract(const core::Frame& frame);
  MaybeTracked localize(const core::Frame& frame, const features::View& view);
  void record(const core::Frame& frame, const features::View& view, const MaybeTracked& tracked);
  void insert_keyframe(const core::Frame& frame, const MaybeTracked& tracked);

  std::optional<core::Rigid3> motion_to(const core::FramePose& newest) const;

  // localize: one for each state.
  MaybeTracked initialize(const core::Frame& frame, const features::View& view);
  MaybeTracked track_in_map(const core::Frame& frame, const features::View& view);
  MaybeTracked relocalize(const core::Frame& frame, const features::View& view);
  // localize: by odometry from a file.
  MaybeTracked follow_odometry(const core::Frame& frame, const features::View& view);

  scene::TrackedView begin_map(const core::Frame& frame, const features::View& view,
                               InitialViews& initial);
  // Motion since the last frame: constant velocity, or odometry from a file.
  core::Rigid3 predicted_motion(const features::View& view) const;
  // Places of the whole map that the view may show; while a relocalization is provisional, of a
  // view some frames ago, and only where it wants them.
  std::optional<std::vector<Place>> places_for(const core::Frame& frame,
                                               const features::View& view);
  void ask_for_places(const core::Frame& frame, const features::View& view);
  // Of the provisional frames before this one.
  void update_provisional(const Relocalization::Result& result);

  // After a gap in the recording the camera may be in a look-alike place: whether motion predicted
  // the pose.
  bool is_plausible(const scene::TrackedView& tracked);
  // Whether the reference keyframe of a frame is in the map that tracking sees.
  bool is_reference_visible(const core::FramePose* frame) const;
  MaybeTracked track_from_last(const features::View& view) const;
  // After the local map has changed: the pose with more inliers is kept.
  void track_again(const features::View& view, MaybeTracked& best) const;
  // With few features, by alignment of the depth image to the one before.
  MaybeTracked track_by_depth(const core::Frame& frame, const features::View& view);
  // The reference becomes the keyframe that shows most of the view's landmarks.
  void switch_reference(scene::TrackedView& tracked);
  // Monocular: a pose whose scale is suspected to have drifted is weak.
  void check_scale(scene::TrackedView& tracked);
  void update_motion_model(const core::Frame& frame, const scene::TrackedView& tracked);

  bool may_reinitialize(const features::View& view) const;
  void discard_poses();
  // The first view of a monocular pair, and the frames between both.
  void pose_earlier_frames(const InitialViews& initial);

  // In a new map odometry from a file leads; a known map is tracked visually.
  bool is_led_by_odometry() const { return odometry_ && !is_map_known_; }
  bool is_worth_keeping(const scene::TrackedView& tracked) const;
  bool can_insert_last() const;
  // The newest frame becomes a keyframe. Empty image: it is no longer known.
  void send_keyframe(const scene::TrackedView& tracked, const cv::Mat& image);
  // The map with the keyframe in progress. Waits.
  void receive_map();

  Config config_;
  bool is_map_known_ = false;
  bool is_map_fixed_ = false;
  core::Timings timings_;
  track::Tracker tracker_;
  SessionState state_;
  Initialization initialization_;
  Relocalization relocalization_;
  std::optional<OdometryTracking> odometry_;  // from a file
  VisibleMap map_;
  MappingExchange mapping_;
  FrameLog log_;
  NewestFrame newest_;
  PassingThings passing_;
  track::ScaleDriftDetector scale_drift_detector_;
  std::vector<track::ScaleDriftInterval> scale_drift_;
};

}  // namespace samewhere::pipeline
