#pragma once

#include <samewhere/core/verdict.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/verify/config.hpp>

namespace samewhere::verify {

// Of a camera without depth: standard deviations of the logarithm of its scale.
struct ScaleErrors {
  double creep = 0.01;  // from one keyframe to the next, at random
  double loop = 0.05;   // as a loop measures it
};

// How far the loop `claim` (its ends, its pose and its scale) would move the query from where the
// map has it, against the drift that odometry may have gathered between the two keyframes (their
// path through the parents; information of the odometry edges). The scale of a camera without depth
// creeps, mostly one way: by how much in all, the claim says itself, so that it is held against the
// path with the lengths that creep would have made of it, spread evenly over its keyframes
// (docs/decisions/027).
core::OdometryEvidence measure_odometry(const scene::MapVersion& map, const scene::LoopEdge& claim,
                                        const ScaleErrors& scale, const Config& config);

// Information of a loop's relative pose: independent errors, loop_sigma_m and loop_sigma_rad.
core::Matrix6d loop_information(const Config& config);

}  // namespace samewhere::verify
