#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/core/rigid3.hpp>

namespace samewhere::input {

// A row of an odometry file.
struct OdometryRow {
  double stamp_s = 0.0;
  core::Rigid3 world_from_body;  // the world is any; only increments are used
  // Of the pose of this body in that of the row before, [m; rad] as in docs/notation.md. None: the
  // file has no covariances, or this is its first row.
  std::optional<core::Matrix6d> covariance;
};

using OdometryRows = std::vector<OdometryRow>;  // stamps ascend strictly; not empty

// Odometry of the body from elsewhere: lines `stamp tx ty tz qx qy qz qw` as in a TUM trajectory,
// '#' comments, a first line that names columns. All lines have 8 columns, 14 (then the six
// variances of the increment since the row before: x y z in m^2, rotation about x y z in rad^2) or
// 29 (the upper triangle of its covariance, row by row). Throws InputError naming file, line and
// value: another number of columns, no finite number, a quaternion whose norm is not 1 within 1 %,
// stamps that do not rise, a covariance that is none, no row.
//
// Of a bag it reads the topic that `topics` names ("odometry=/odom"), or the only one
// (bag_poses.hpp).
OdometryRows read_odometry(const std::filesystem::path& path, const std::string& topics = {});

}  // namespace samewhere::input
