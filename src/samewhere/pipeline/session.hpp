#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include <opencv2/core/mat.hpp>

#include <samewhere/scene/tracked_view.hpp>
#include <samewhere/track/config.hpp>

namespace samewhere::pipeline {

// Source of landmark depth. kMotion: monocular; the map is initialized from two views and its scale
// is unknown.
enum class DepthFrom { kSensor, kMotion };

// kInitializing: there is no map yet. kTracking, kWeak, kRelocalized: the last frame has a pose, of
// this kind. kLost: it has none. kProvisional: it has one that may be in a look-alike place.
enum class SessionPhase { kInitializing, kTracking, kWeak, kLost, kRelocalized, kProvisional };

// The last frame with a pose, from which the next one is predicted.
struct TrackedFrame {
  scene::TrackedView tracked;
  std::optional<cv::Mat> depth_m;
  core::Rigid3 last_from_next;  // constant velocity: the last motion is repeated
};

// State of a session, with the data that each state needs. A transition that a state does not have
// throws ContractError:
//
//   initializing -> initialize -> tracking
//   tracking     -> track, lose, or as before
//   lost         -> track (relocalized), hold, lose, or initialize (re-initialization)
//   provisional  -> track (confirmed), hold, or lose (taken back)
//
// A provisional session is lost in all but its phase: nothing is written to the map.
class SessionState {
 public:
  // A new map, of one camera if it is monocular.
  SessionState(const track::Config& config, DepthFrom depth_from)
      : config_(config), depth_from_(depth_from) {}
  // A session in a known map starts lost, and never discards that map.
  static SessionState in_known_map(const track::Config& config, std::uint64_t num_keyframes);

  SessionPhase phase() const;
  DepthFrom depth_from() const { return depth_from_; }
  bool is_initializing() const { return phase() == SessionPhase::kInitializing; }
  // Also while a relocalization is provisional.
  bool is_lost() const { return std::holds_alternative<Lost>(state_); }
  // Of the frame before; nullptr: it has no pose.
  const TrackedFrame* last_frame() const { return std::get_if<TrackedFrame>(&state_); }
  TrackedFrame* last_frame() { return std::get_if<TrackedFrame>(&state_); }
  // The camera has been tracked without loss since the keyframe of this index was inserted.
  std::uint64_t tracked_since_keyframe() const { return tracked_since_keyframe_; }
  // How often the map was discarded for a new one.
  int num_reinitializations() const { return num_reinitializations_; }

  // A map begins with this frame; an earlier one is discarded.
  void initialize(TrackedFrame first);
  // The frame has a pose. After a loss its status is kResumed.
  void track(TrackedFrame frame);
  // The frame has a provisional pose. `num_keyframes`: inserted so far.
  void hold(std::uint64_t num_keyframes);
  // The frame has no pose. `num_keyframes`: inserted so far.
  void lose(std::uint64_t num_keyframes);

  // Of the current map.
  struct MapAge {
    std::uint64_t num_keyframes = 0;
    std::optional<double> last_pose_at_s;  // none: it has no pose
  };
  // Whether a lost session may discard the map: the map is small or, with depth, was tracked for
  // less time than the camera is lost. With depth a number of lost frames has to pass first, since
  // an occlusion may end.
  bool may_reinitialize(double stamp_s, const MapAge& map) const;

 private:
  struct NoMap {};
  struct Lost {
    bool is_provisional = false;
  };

  bool is_map_provisional(double stamp_s, const MapAge& map) const;

  track::Config config_;
  DepthFrom depth_from_ = DepthFrom::kSensor;
  bool is_map_known_ = false;
  std::variant<NoMap, TrackedFrame, Lost> state_;
  int num_lost_frames_ = 0;  // since track(); initialize() alone does not end the count
  double initialized_at_s_ = 0.0;
  std::uint64_t tracked_since_keyframe_ = 0;
  int num_reinitializations_ = 0;
};

}  // namespace samewhere::pipeline
