#pragma once

#include <samewhere/core/rigid3.hpp>
#include <samewhere/track/config.hpp>

namespace samewhere::track {

// Information of a relative pose that odometry measured: independent errors with standard
// deviations base + slope * (metres moved, radians turned). Not the solver's Hessian, which knows
// nothing of wrong matches and of calibration and is many times too sure.
core::Matrix6d odometry_information(const core::Rigid3& reference_from_frame, bool is_weak,
                                    const DriftConfig& config);

}  // namespace samewhere::track
