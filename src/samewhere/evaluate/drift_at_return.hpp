#pragma once

#include <optional>

#include <samewhere/core/truth.hpp>

namespace samewhere::evaluate {

// Error of odometry when the camera first comes back to a place.
struct DriftAtReturn {
  double drift_m = 0.0;  // odometry aligned at the earlier visit
  double path_m = 0.0;   // true length between the visits
  double stamp_s = 0.0;  // of the return
};

// The first pose within 1 m and 45 degrees of one that lies at least 5 m of path before it.
// Nothing if there is none, or odometry has no pose at either visit. `not_before_s`: where the
// source knows its revisits, the begin of the first.
std::optional<DriftAtReturn> drift_at_first_return(const core::Trajectory& truth,
                                                   const core::Trajectory& odometry,
                                                   std::optional<double> not_before_s = {});

}  // namespace samewhere::evaluate
