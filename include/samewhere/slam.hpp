#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/errors.hpp>
#include <samewhere/event.hpp>
#include <samewhere/map.hpp>
#include <samewhere/types.hpp>

namespace samewhere {

/// How a saved map is used.
enum class MapUse {
  kExtend,   ///< the map grows in its file
  kLocalize  ///< the map stays as it is
};

/// How a session works.
struct Options {
  std::string profile = "default";    ///< "default", "recognition", "paper" or "usual"
  std::vector<std::string> settings;  ///< "section.key=value", docs/config.md
  std::optional<Prior> prior;         ///< verify.prior; empty: as in the profile and the settings
  /// Mapping, loop closing and full bundle adjustment in a thread each; the results are identical.
  bool threads = true;
  /// track() does not wait for them: results are applied to the first frame for which they are
  /// ready, so that a session cannot be repeated to the bit. Needs `threads`.
  bool never_wait = false;
  std::filesystem::path map;         ///< a saved map to begin in, lost; empty: a new map
  MapUse map_use = MapUse::kExtend;  ///< of `map`
  std::filesystem::path save_to;     ///< a new file in which a new map grows; empty: none
  /// Called with each event at the end of track() and finish(), in their thread; take_events() then
  /// gives none. Must not call the session.
  std::function<void(const Event&)> on_event;
};

/// What tracking knows at a frame.
enum class Status {
  kInitializing,  ///< there is no map yet
  kTracking,      ///< the pose is measured
  kWeak,          ///< the pose is measured with few inliers
  kLost,          ///< no pose
  kProvisional    ///< relocalized, not confirmed; it may be a look-alike place
};

/// The camera at one frame; camera 0 as it was given, before rectification.
struct Tracked {
  std::uint64_t frame = 0;                ///< index, from 0
  double stamp_s = 0.0;                   ///< of the frame, seconds
  Status status = Status::kInitializing;  ///< whether the pose is measured
  /// The chain of the frames' relative poses: smooth, never moved by a correction. While lost it is
  /// predicted for half a second, then it stands still.
  Pose odom_from_camera = Pose::Identity();
  /// Changes with loop closures, bundle adjustment and relocalization (REP-105). Of the last
  /// confirmed pose; identity before there is one.
  Pose map_from_odom = Pose::Identity();
  std::optional<Pose> provisional_map_from_camera;  ///< of status kProvisional
  /// Of the body's pose relative to its reference keyframe, by the drift model; axes of both bodies
  /// as in docs/notation.md. Empty: no pose.
  std::optional<Covariance> covariance;
  int num_inliers = 0;            ///< landmarks that agree with the pose
  std::uint64_t map_version = 0;  ///< Map::version() that the frame was tracked in

  /// The pose in the map, metres; of the last confirmed pose if there is none now.
  Pose map_from_camera() const { return map_from_odom * odom_from_camera; }
  /// The pose is measured: kTracking or kWeak.
  bool has_pose() const { return status == Status::kTracking || status == Status::kWeak; }
};

/// The pose of a frame after all corrections.
struct StampedPose {
  double stamp_s = 0.0;                     ///< of the frame, seconds
  Pose map_from_camera = Pose::Identity();  ///< camera 0 as it was given, before rectification
};

/// Visual SLAM, frame by frame. On recorded input it gives the same poses and verdicts as
/// `samewhere run`, to the bit, unless never_wait is set. OpenCV is set to one thread.
///
/// One thread at a time calls it; map() and take_events() may be called from any. A frame that is
/// refused (InputError) changes nothing. After an internal error the session is over: calls throw
/// UsageError until reset().
class Slam {
 public:
  /// Throws InputError on a calibration, setting or map that cannot be used.
  explicit Slam(const Calibration& calibration, const Options& options = {});
  /// Ends the threads; finish() is not called.
  ~Slam();
  Slam(const Slam&) = delete;
  Slam& operator=(const Slam&) = delete;

  /// Takes the next frame and gives its pose. Throws InputError: an image is missing or has another
  /// size or format than the calibration says,
  /// depth of another size, a stamp that does not rise. UsageError: after finish(), or another
  /// thread is in a call.
  Tracked track(const Frame& frame);

  /// Events since the last call, oldest first. The newest 10,000 are kept. None with
  /// Options::on_event.
  std::vector<Event> take_events();
  /// The map as the newest frame saw it; never nullptr.
  std::shared_ptr<const Map> map() const;

  /// A new file with the map as of the newest keyframe that mapping has completed. Throws
  /// InputError if there is a file already, it cannot be written or there is no map yet; UsageError
  /// in a session that began in a saved map, which grows in its own file.
  void save(const std::filesystem::path& file) const;
  /// Ends the session and begins one in a saved map, lost until relocalized. Throws InputError;
  /// then the session goes on.
  void load(const std::filesystem::path& file, MapUse use);
  /// Ends the session and begins a new one with an empty map. Options::map and save_to are not used
  /// again.
  void reset();
  /// No keyframe is inserted from the next frame on; tracking and relocalization go on. A map that
  /// has not begun begins all the same.
  void pause_mapping();
  /// Keyframes are inserted again from the next frame on.
  void resume_mapping();

  /// The input has ended: completes what is in progress. From then on trajectory() is final. Throws
  /// InputError if the map file could not be written to its end.
  void finish();
  /// finish() has been called and the session was not begun again.
  bool is_finished() const;
  /// Camera 0 at each frame with a confirmed pose, after all corrections. Throws UsageError before
  /// finish().
  std::vector<StampedPose> trajectory() const;

 private:
  class Session;
  explicit Slam(std::unique_ptr<Session> session);
  friend struct SlamMaker;  // not part of the interface

  std::unique_ptr<Session> session_;
};

}  // namespace samewhere
