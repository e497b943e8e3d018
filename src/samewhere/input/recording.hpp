#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/core/truth.hpp>

namespace samewhere::input {

// Where one frame lies.
struct FrameFiles {
  std::string name;  // for messages
  double stamp_s = 0.0;
  std::filesystem::path image;
  std::filesystem::path depth;  // empty: this frame has none
};

// A recording of any format, before its images are read.
struct Recording {
  std::string format;
  std::vector<FrameFiles> frames = {};
  double depth_units_per_m = 1000.0;
  std::filesystem::path camera_file = {};  // empty: the camera is not known
  core::Truth truth = {};
};

}  // namespace samewhere::input
