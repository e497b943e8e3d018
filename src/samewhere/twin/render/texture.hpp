#pragma once

#include <samewhere/twin/building/noise.hpp>
#include <samewhere/twin/building/surface.hpp>

namespace samewhere::twin {

// Share of the light that a point of the surface sends back; of emitting finishes, the light that
// it sends out over the material's radiance. Textures are procedural: noise in octaves, patterns
// and print, with wear on top, filtered to the footprint of the pixel.
Colour reflectance(const Rectangle& rectangle, const TexturePoint& point);

// The same averaged over the whole surface, roughly: what other surfaces are lit by.
Colour mean_reflectance(const Material& material);

bool is_emitting(const Material& material);

}  // namespace samewhere::twin
