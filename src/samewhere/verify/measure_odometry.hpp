#pragma once

#include <optional>

#include <samewhere/core/verdict.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/verify/config.hpp>
#include <samewhere/verify/map_drift.hpp>

namespace samewhere::verify {

// Odometry gate: the correction of the query's pose by the loop `claim`, and its Mahalanobis
// distance under the drift accumulated between both keyframes (their chain of odometry edges) and
// the covariance of the loop; also how much likelier the place is than a look-alike place. Without
// depth the total scale drift is that of the claim; it is spread evenly over the keyframes of the
// chain before the comparison (docs/decisions/027).
core::OdometryEvidence measure_odometry_alone(MapDrift& drift, const scene::LoopEdge& claim);

// The same, with depth under covariances that are as large as the loops closed so far show
// (variance_factor.hpp); where it passes the gate, also by odometry and those loops together.
core::OdometryEvidence measure_odometry(MapDrift& drift, const scene::LoopEdge& claim);

// What the loop `claim`, if it is closed in this map, tells of odometry. Nothing without depth, and
// where it tells nothing new.
std::optional<scene::DriftSample> measure_drift(MapDrift& drift, const scene::LoopEdge& claim);

// How near a look-alike place may be: metres, or without depth median depths.
double least_look_alike_distance(const scene::MapVersion& map, const Config& config);

// Information of a loop's relative pose: independent errors, loop_sigma_m and loop_sigma_rad.
core::Matrix6d loop_information(const Config& config);

}  // namespace samewhere::verify
