#pragma once

#include <optional>

#include <samewhere/geometry/uncertain_pose.hpp>
#include <samewhere/verify/systematic_drift.hpp>

namespace samewhere::pipeline {

// A motion by odometry from a file.
struct OdometryMotion {
  geometry::UncertainPose before_from_after;
  double duration_s = 0.0;
  bool has_gap = false;  // some of the motion is not measured
  // Odometry that lies in a plane: its normal in the body before. It measures no height.
  std::optional<Eigen::Vector3d> normal_in_before;
};

// The motion, and whether images contradict odometry.
struct CombinedMotion : geometry::UncertainPose {
  bool is_contradicted = false;
};

// The motion that odometry and images together give. Images: the body after in the body before by
// features, none where they show too few landmarks.
//
// In a gap of odometry the motion is that of the images. Odometry in a plane: height, roll and
// pitch are those of the images. What no image has seen, as a ride in a lift, leaves the height
// unknown. The rest of the pose stays that of odometry. Where images contradict it (a slipping
// wheel), its covariance is enlarged by the difference.
CombinedMotion combine_with_images(const OdometryMotion& odometry,
                                   const std::optional<geometry::UncertainPose>& images,
                                   const verify::SystematicDrift& drift);

}  // namespace samewhere::pipeline
