#pragma once

#include <samewhere/twin/building/noise.hpp>
#include <samewhere/twin/building/surface.hpp>

namespace samewhere::twin {

// What is printed on things; the point is measured from the lower left corner of the rectangle.

// Room number with lines of names under it.
Colour door_plate(const Rectangle& plate, const TexturePoint& point);
// Heading, picture and lines of text in a layout and colours that follow from the pattern seed.
Colour poster(const Rectangle& paper, const TexturePoint& point);
// A white arrow, stairs, a lift, a person or an extinguisher in a frame; which one says `number`
// (Pictogram).
Colour pictogram(const Rectangle& sign, const TexturePoint& point);
// A bar code with lines of text under it.
Colour label(const Rectangle& paper, const TexturePoint& point);
// The material's number as high as the rectangle lets it be.
Colour big_number(const Rectangle& sign, const TexturePoint& point);

}  // namespace samewhere::twin
