#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/errors.hpp>
#include <samewhere/event.hpp>
#include <samewhere/map.hpp>
#include <samewhere/types.hpp>

namespace samewhere {

/// What measured the odometry: the row of the drift model (docs/decisions/033).
enum class OdometrySensor {
  kCovariances,  ///< each keyframe comes with the covariance of its increment
  kWheel,        ///< wheel encoders
  kLeg,          ///< legged robot
  kInertial,     ///< inertial odometry
  kVisual,       ///< visual odometry
  kPoor          ///< the largest drift
};

/// How a LoopCloser works.
struct LoopCloserOptions {
  OdometrySensor sensor = OdometrySensor::kWheel;  ///< the drift model
  std::string profile = "default";                 ///< "default", "recognition", "paper" or "usual"
  std::vector<std::string>
      settings;                ///< "section.key=value"; section `odometry` has the drift model
  std::optional<Prior> prior;  ///< verify.prior; empty: as in the profile and the settings
  bool threads = true;  ///< mapping and loop closing in a thread each; the results are identical
  /// Keyframes: all that is given is used. False: frames of a camera, of which keyframes are chosen
  /// as `samewhere run --odometry` does.
  bool are_keyframes = true;
};

/// Images and odometry of one moment.
struct OdometryFrame {
  Frame frame;                             ///< as for Slam::track()
  Pose odom_from_body = Pose::Identity();  ///< odometry at its stamp, metres
  /// Of the body's motion since the frame before, in that frame's body, [m; rad]; for kCovariances.
  /// Not used of the first frame.
  std::optional<Covariance> covariance;
};

/// The pose of a frame after all loop closures.
struct CorrectedPose {
  double stamp_s = 0.0;  ///< of the frame, seconds
  Pose map_from_body =
      Pose::Identity();  ///< metres; equals the odometry at the first frame of the map
};

/// Loop closures for odometry from elsewhere: wheels, legs, lidar, a VIO. Keyframes and odometry
/// in; verdicts and corrected poses out. Features find landmarks and loops only: poses between
/// loops are those of odometry. Gives the verdicts of `samewhere run --odometry`.
///
/// One thread at a time calls it. Errors as in Slam.
class LoopCloser {
 public:
  /// Throws InputError on a calibration or setting that cannot be used.
  explicit LoopCloser(const Calibration& calibration, const LoopCloserOptions& options = {});
  /// Ends the threads; finish() is not called.
  ~LoopCloser();
  LoopCloser(const LoopCloser&) = delete;
  LoopCloser& operator=(const LoopCloser&) = delete;

  /// Takes the next keyframe. Verdicts that are known now, of it or earlier ones. Throws InputError
  /// as Slam::track() and for a pose that is not finite or no rotation, and a covariance that is
  /// missing or not positive definite.
  std::vector<LoopVerdict> add(const OdometryFrame& keyframe);
  /// The input has ended: the verdicts that are left. From then on poses() is final.
  std::vector<LoopVerdict> finish();

  /// Of all frames given whose pose the map knows; before finish() the newest few are left out.
  std::vector<CorrectedPose> poses() const;
  /// The map as the newest keyframe saw it, after finish() the last one; never nullptr.
  std::shared_ptr<const Map> map() const;

 private:
  class Session;
  std::unique_ptr<Session> session_;
};

}  // namespace samewhere
