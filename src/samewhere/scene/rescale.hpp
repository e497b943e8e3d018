#pragma once

#include <vector>

#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {

// Corrects scale drift of a camera without depth, which a loop measures. `factors`: one per
// keyframe; those of culled ones are not used (the factor of their holder is). Lengths measured
// from keyframe i are multiplied by factors[i]: points anchored there, odometry and loop edges that
// begin there, culled keyframes held there. Keyframe::log_scale accumulates the factors, because an
// odometry edge was measured in one scale for keyframe and parent. Poses stay.
void rescale(MapVersion& map, std::vector<double> factors);

}  // namespace samewhere::scene
