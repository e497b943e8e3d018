#pragma once

#include <optional>

#include <samewhere/scene/map_version.hpp>
#include <samewhere/verify/config.hpp>

namespace samewhere::verify {

// By how much the covariances of odometry are too large, as the loops closed so far show: a
// posteriori variance factor of their errors (Koch, "Parameter estimation and hypothesis testing in
// linear models", 1999), in [Config::min_variance_factor, 1]. Prior: 1, with the weight
// of two loops. Above 1 nothing is learned, since the odometry gate has cut off larger errors.
// `sigma_m`: the standard deviation of a position under the drift that it is for. A loop over a
// drift of less than a quarter of that does not count: drift may grow faster than its covariance.
double variance_factor(const scene::MapVersion& map, double sigma_m, const Config& config);

// What a loop with this error tells of odometry. `covariance` and `with_loops`: of the query's pose
// in the match, [m; rad], by odometry alone, and with the loops of before. Nothing
// where those have taken out more than half of the variance: views of one revisit have one error.
std::optional<scene::DriftSample> drift_sample(const core::Vector6d& error,
                                               const core::Matrix6d& covariance,
                                               const std::optional<core::Matrix6d>& with_loops,
                                               const Config& config);

// Standard deviation of the position in its least certain direction, metres.
double least_certain_sigma_m(const core::Matrix6d& covariance);

}  // namespace samewhere::verify
