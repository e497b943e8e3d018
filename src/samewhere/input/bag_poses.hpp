#pragma once

#include <filesystem>
#include <string>

#include <samewhere/bags/bag.hpp>
#include <samewhere/core/truth.hpp>
#include <samewhere/input/odometry_file.hpp>
#include <samewhere/input/transforms.hpp>

namespace samewhere::input {

// All transforms of /tf_static, and of /tf if `with_moving`.
Transforms read_transforms(bags::BagReader& bag, bool with_moving);

// Poses of `camera_frame` from a topic of PoseStamped, PoseWithCovarianceStamped, TransformStamped,
// Odometry or TF (from the root of its tree). A pose of another frame is moved to the camera by
// /tf_static, if it tells how; else it is taken for the camera's, and the log says so. Poses whose
// stamps do not rise are left out.
core::Trajectory read_poses(bags::BagReader& bag, int topic, const std::string& camera_frame);

// Odometry for input::read_odometry from the topic of nav_msgs/Odometry that `wanted` names
// ("odometry=/odom"), or the only one; the body is the camera whose pictures the recording has.
// Without covariances: those of a nav_msgs/Odometry are of the pose since the start, and not of its
// increments. Throws InputError as bags::open_bag and choose_odometry do, and if there is no pose.
OdometryRows read_bag_odometry(const std::filesystem::path& path, const std::string& wanted);

}  // namespace samewhere::input
