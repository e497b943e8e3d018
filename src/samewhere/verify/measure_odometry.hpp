#pragma once

#include <samewhere/core/verdict.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/verify/config.hpp>

namespace samewhere::verify {

// How far the loop `claim` (its ends and its pose) would move the query from where the map has it,
// against the drift that odometry may have gathered between the two keyframes (their path through
// the parents; information of the odometry edges). Of a camera without depth, also against what its
// scale may have crept: a share of scale_sigma at every keyframe, which stretches the rest of the
// path.
core::OdometryEvidence measure_odometry(const scene::MapVersion& map, const scene::LoopEdge& claim,
                                        double scale_sigma, const Config& config);

// Information of a loop's relative pose: independent errors, loop_sigma_m and loop_sigma_rad.
core::Matrix6d loop_information(const Config& config);

}  // namespace samewhere::verify
