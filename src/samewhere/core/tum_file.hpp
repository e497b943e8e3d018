#pragma once

#include <filesystem>
#include <string>

#include <samewhere/core/text_file.hpp>
#include <samewhere/core/truth.hpp>

namespace samewhere::core {

// What is made of columns after the eight of a pose, covariances say.
enum class MoreColumns { kRefused, kSkipped };

// A trajectory in the format of the TUM RGB-D benchmark: lines `stamp tx ty tz qx qy qz qw`
// (seconds, metres, rotation as a quaternion that is normalised here), blank lines and '#'
// comments. Throws InputError naming file and line if a line is short or, unless they are skipped,
// has more columns, a value is no finite number, a quaternion is zero, or stamps do not rise.
Trajectory read_tum(const std::filesystem::path& path, MoreColumns more = MoreColumns::kRefused);

// A pose from a line of that format, its values between blanks or commas. Throws InputError as
// above.
StampedPose tum_pose(const TextLine& line);

// The same format, fixed: six decimals for the stamp, nine for the pose.
std::string tum_text(const Trajectory& trajectory);

}  // namespace samewhere::core
