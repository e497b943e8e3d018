#pragma once

#include <vector>

#include <samewhere/twin/ray_scene.hpp>
#include <samewhere/twin/surface.hpp>
#include <samewhere/twin/surface_colours.hpp>

namespace samewhere::twin {

// How much light falls on every surface: from lamps and windows with soft shadows, and by way of
// the other surfaces (one bounce gathered, the further ones estimated from it). As irradiance over
// pi: times the reflectance it is the light that a matt surface sends back.
SurfaceColours light_on(const std::vector<Rectangle>& rectangles, const RayScene& rays);

}  // namespace samewhere::twin
