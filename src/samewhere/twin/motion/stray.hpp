#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include <samewhere/core/random.hpp>
#include <samewhere/twin/motion/drive.hpp>
#include <samewhere/twin/motion/shake.hpp>
#include <samewhere/twin/render/ray_scene.hpp>

namespace samewhere::twin {

// How far one can step aside from a point of the floor, where heading_rad says which way, before
// anything is nearer than an elbow: metres, not below 0.
using Room = std::function<double(const Eigen::Vector3d& floor_m, double heading_rad)>;

// Lateral offset of a walk from the middle of the way, so that a place is seen from another side
// on the way back.
struct Stray {
  double most_m = 0.0;  // to either side; 0: not at all
  Room room_m;          // asked only if most_m is above 0
};

// At most `most_m`, felt for by rays: what stands on the floor, hangs on a wall or rises above a
// step is in the way, and so is an edge.
double room_in(const RayScene& rays, const Eigen::Vector3d& floor_m, double heading_rad,
               double most_m);

// Shifts a drive to its left and right, smoothly, as waves over the distance walked, as far as
// there is room around each point; not where the carrier stands, turns or rides a lift. Headings
// stay as they are.
void step_aside(const Stray& stray, core::Random& random, Drive& drive);

// Holds the camera turned, pitched and raised or lowered, slowly changing: at most 20 degrees, 6
// degrees and 0.25 m per metre of `most_m`.
void hold_elsewhere(double most_m, core::Random& random, CameraShake& shake);

}  // namespace samewhere::twin
