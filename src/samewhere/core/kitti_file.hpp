#pragma once

#include <string>

#include <samewhere/core/truth.hpp>

namespace samewhere::core {

// A trajectory in the format of KITTI odometry: a line per pose, the upper three rows of
// world_from_camera, row by row, twelve numbers with nine decimals, metres. The format has no
// stamps: line n is pose n.
std::string kitti_text(const Trajectory& trajectory);

}  // namespace samewhere::core
