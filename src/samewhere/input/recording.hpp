#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/rig.hpp>
#include <samewhere/core/truth.hpp>

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
  std::vector<core::ImuSample> imu = {};   // stamps rise
  core::Truth truth = {};
};

}  // namespace samewhere::input
