#include <cmath>

#include <samewhere/twin/building/surface.hpp>

namespace samewhere::twin {

Colour colour_of_srgb(float red, float green, float blue) {
  return {std::pow(blue, 2.2F), std::pow(green, 2.2F), std::pow(red, 2.2F)};
}

}  // namespace samewhere::twin
