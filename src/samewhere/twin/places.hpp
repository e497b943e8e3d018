#pragma once

#include <samewhere/core/rig.hpp>
#include <samewhere/core/truth.hpp>
#include <samewhere/twin/building.hpp>
#include <samewhere/twin/ray_scene.hpp>

namespace samewhere::twin {

// Which frames of a walk show the same place, from exact geometry (docs/evaluation.md, pr-v2).
// overlap(q, m): share of what q sees, by a grid of 20 x 15 rays, that m sees too: it lies in m's
// picture and the surface that m sees there is as far away, within 5 cm + 4 %. Same: at least 0.3
// both ways and viewing directions within 45 degrees; different: below 0.05 both ways; else near.
core::PlaceTruthMatrix places_of(const core::Trajectory& walk, const Building& building,
                                 const RayScene& rays, const core::Camera& camera);

}  // namespace samewhere::twin
