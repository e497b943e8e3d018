#pragma once

#include <vector>

#include <samewhere/twin/building/presets.hpp>
#include <samewhere/twin/building/route.hpp>

namespace samewhere::twin {

// Walks on through all points, in the world.
void walk(Route& route, const std::vector<Eigen::Vector3d>& points_m);
// Turns on the spot.
void turn(Route& route, double heading_deg);

// About how long a route takes: its length over its speed, stairs slower, turns on the spot at 80
// degrees a second, 0.65 s lost in a bend of 90 degrees, and the time stood.
double estimated_duration_s(const Route& route);

// The floor points of the route: its start and every point walked to.
std::vector<Eigen::Vector3d> points_of(const Route& route);

// Where people may walk so that the camera meets them: along the route, each stretch on one floor
// once.
std::vector<PersonPath> paths_along(const Route& route);

}  // namespace samewhere::twin
