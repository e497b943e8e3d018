#pragma once

#include <samewhere/core/rigid3.hpp>

namespace samewhere::verify {

// Log-likelihood ratio, times two, of a place over the most likely look-alike of it. `error`: of
// the claimed pose against odometry, [m; rad]; `covariance`: of that error. A look-alike place has
// the same orientation and is displaced by at least `distance_m` in any direction, so that the
// camera would be there and the error would be smaller by that displacement. Negative where a
// look-alike explains the error better. Formula: chi-square(nearest displacement on or beyond the
// sphere) - chi-square(no displacement).
double look_alike_gain(const core::Vector6d& error, const core::Matrix6d& covariance,
                       double distance_m);

}  // namespace samewhere::verify
