#pragma once

#include <optional>

#include <samewhere/geometry/uncertain_pose.hpp>
#include <samewhere/verify/map_drift.hpp>

// For the files of this folder that hold claims against odometry.

namespace samewhere::verify {

// Pose of the end in the beginning by the map, with the covariance of odometry alone between them.
// Without depth in the scale of the beginning, given a scale drift of exp(log_scale) along the
// path: even over the keyframes plus a random part (a Brownian bridge), and none between the ends
// of a closed loop. The covariance is that of odometry, scaled with the path's length, and of the
// scale. Nothing if odometry does not join the two.
std::optional<geometry::UncertainPose> expected_end(MapDrift& drift, core::KeyframeId begin,
                                                    core::KeyframeId end, double log_scale,
                                                    const ScaleErrors& scale);

// How far a claimed pose is from a known one [m in `begin`; rad].
core::Vector6d difference(const core::Rigid3& known, const core::Rigid3& claimed);

}  // namespace samewhere::verify
