#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/rig.hpp>
#include <samewhere/core/truth.hpp>
#include <samewhere/input/config.hpp>

namespace samewhere::input {

// Where one frame lies.
struct FrameFiles {
  std::string name;  // for messages
  double stamp_s = 0.0;
  std::vector<std::filesystem::path> images = {};  // one per camera, at least one
  std::filesystem::path depth = {};                // empty: this frame has none
};

// A recording of any format, before its images are read.
struct Recording {
  std::string format;
  std::vector<FrameFiles> frames = {};  // all with as many images
  double depth_units_per_m = 1000.0;
  // No camera in it: the format tells of none. A camera of 0 x 0 pixels has the size of its
  // pictures.
  core::Rig rig = {};
  std::filesystem::path camera_file = {};  // if not empty, it says what camera 0 is
  bool needs_calibration = true;  // else a calibration that does not fit is warned of and left out
  std::vector<core::ImuSample> imu = {};  // stamps rise
  core::Truth truth = {};
  bool is_place_truth_final = false;  // truth.places is not to be widened: its reader did
};

// Leaves out all cameras but the first, as where it is not known how they sit to each other.
void keep_first_camera(Recording& recording);

// Calls `read`, which fills in recording.rig. Where that throws InputError although another
// calibration was given (input.camera) or none is needed, the rig is empty afterwards, one camera
// is kept, and false is returned; where none was given the log has a warning.
bool read_own_rig(const Config& config, Recording& recording, const std::function<void()>& read);

}  // namespace samewhere::input
