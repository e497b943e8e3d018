#pragma once

#include <vector>

#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {

// A camera without depth does not know how long anything is: its scale creeps from keyframe to
// keyframe, until a loop shows by how much. `factors`: one per keyframe, those of culled ones are
// not looked at (they go with what they hang on). What was measured from keyframe i becomes
// factors[i] times as long: points anchored there, edges of odometry and loops that begin there,
// keyframes that hang there. Its log_scale keeps count, so that it stays known that odometry, when
// it was measured, saw keyframe and parent in one scale. Poses stay.
void rescale(MapVersion& map, std::vector<double> factors);

}  // namespace samewhere::scene
