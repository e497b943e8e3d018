#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include <samewhere/core/result.hpp>
#include <samewhere/core/rig.hpp>
#include <samewhere/input/transforms.hpp>
#include <samewhere/messages/messages.hpp>
#include <samewhere/node/config.hpp>
#include <samewhere/node/incoming.hpp>
#include <samewhere/node/pairing.hpp>
#include <samewhere/types.hpp>

namespace samewhere::node {

// The sensors, and the frame of the robot that odometry and map refer to.
struct Setup {
  Calibration calibration;
  std::string base_frame;
  Pose camera_from_base = Pose::Identity();
  core::Camera first_camera;  // as its camera_info describes it
};

// What comes before the first frame is tracked: holds the first frames until calibration, frame
// rate and the camera's place on the robot are known.
//
// The place of the right camera is that of the calibrations (R, P) or, if they tell of none, that
// of /tf_static. If /tf_static connects node.base_frame with the camera, that is the base. If it
// does not within node.tf_wait_s, the base is the top of the tree that holds the camera, or the
// camera itself.
class Startup {
 public:
  explicit Startup(Config config);

  // The first of each stream with a calibration counts. Throws core::InputError on one that is not
  // usable.
  void take_info(Stream stream, const messages::CameraInfo& info);
  // Returns how many frames it dropped for it: it holds a few.
  std::uint64_t add(FrameSet frame);
  // All that is known, or what is waited for. Throws core::InputError if the calibrations do not
  // make a stereo pair.
  Result<Setup, std::string> setup(const input::Transforms& transforms) const;
  std::deque<FrameSet> take_frames();

 private:
  struct CalibratedCamera {
    Camera camera;
    messages::CameraInfo info;
    core::Camera model;
  };

  std::optional<double> frame_rate_hz() const;
  // For transforms that did not come yet.
  bool may_wait() const;
  Result<Setup, std::string> place_of_camera(const input::Transforms& transforms) const;
  Result<Pose, std::string> place_of_right_camera(const input::Transforms& transforms) const;

  Config config_;
  std::optional<CalibratedCamera> first_;
  std::optional<CalibratedCamera> second_;
  std::deque<FrameSet> frames_;
  std::optional<double> first_stamp_s_;
};

}  // namespace samewhere::node
