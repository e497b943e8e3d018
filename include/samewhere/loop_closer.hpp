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

// What measured the odometry: the row of the drift model (docs/decisions/033). kCovariances: each
// keyframe comes with the covariance of its increment.
enum class OdometrySensor { kCovariances, kWheel, kLeg, kInertial, kVisual, kPoor };

struct LoopCloserOptions {
  OdometrySensor sensor = OdometrySensor::kWheel;
  std::string profile = "default";
  std::vector<std::string> settings;  // "section.key=value"; section `odometry` has the drift model
  std::optional<Prior> prior;
  bool threads = true;
  // Keyframes: all that is given is used. False: frames of a camera, of which keyframes are chosen
  // as `samewhere run --odometry` does.
  bool are_keyframes = true;
};

// Images and odometry of one moment.
struct OdometryFrame {
  Frame frame;
  Pose odom_from_body = Pose::Identity();
  // Of the body now in that at the frame before, [m; rad]; for kCovariances. Not of the first.
  std::optional<Covariance> covariance;
};

struct CorrectedPose {
  double stamp_s = 0.0;
  Pose map_from_body = Pose::Identity();  // the map begins where the odometry of its first frame is
};

// Loop closures for odometry from elsewhere: wheels, legs, lidar, a VIO. Keyframes and odometry in;
// verdicts and corrected poses out. Features find landmarks and loops only: poses between loops are
// those of odometry. Gives the verdicts of `samewhere run --odometry`.
//
// One thread at a time calls it. Errors as in Slam.
class LoopCloser {
 public:
  explicit LoopCloser(const Calibration& calibration, const LoopCloserOptions& options = {});
  ~LoopCloser();
  LoopCloser(const LoopCloser&) = delete;
  LoopCloser& operator=(const LoopCloser&) = delete;

  // Verdicts that are known now, of this keyframe or earlier ones. Throws InputError as
  // Slam::track() and for a pose that is not finite or no rotation, and a covariance that is
  // missing or not positive definite.
  std::vector<LoopVerdict> add(const OdometryFrame& keyframe);
  // The input has ended: the verdicts that are left.
  std::vector<LoopVerdict> finish();

  // Of all frames given whose pose the map knows; before finish() the newest few are left out.
  std::vector<CorrectedPose> poses() const;
  // The map as the newest keyframe saw it; after finish() the last one.
  std::shared_ptr<const Map> map() const;

 private:
  class Session;
  std::unique_ptr<Session> session_;
};

}  // namespace samewhere
