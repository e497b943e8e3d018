#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <samewhere/core/ids.hpp>
#include <samewhere/core/truth.hpp>
#include <samewhere/report/record.hpp>

namespace samewhere::report {

// The frames whose pose was measured, after all corrections.
core::Trajectory measured_trajectory(const std::vector<FrameRecord>& frames);

// Every frame, one line each: index, stamp, name, status, whether the pose was measured, inliers,
// reference keyframe, and world_from_camera (metres, quaternion; empty if not measured). RFC 4180.
std::string frames_csv(const std::vector<FrameRecord>& frames);

// What frames.csv holds of all frames.
struct FrameTimes {
  std::vector<double> stamps_s;         // by position
  std::set<core::FrameId> relocalized;  // frames at which tracking was relocalized
};

// Throws InputError, naming file and line, if it cannot be read or a line is not of such a file.
FrameTimes read_frames_csv(const std::filesystem::path& path);

// The same file with other poses, one for each frame whose pose was measured. Throws InputError
// that names no file if there are more or fewer of these.
std::string with_poses(const std::string& frames_csv, const core::Trajectory& trajectory);

}  // namespace samewhere::report
