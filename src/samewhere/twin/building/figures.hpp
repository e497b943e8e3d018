#pragma once

#include <cstdint>
#include <vector>

#include <samewhere/twin/building/surface.hpp>

namespace samewhere::twin {

// Appearance of a person.
struct Look {
  float height_m = 1.75F;
  float girth = 1.0F;  // over the usual
  bool has_skirt = false;
  bool has_long_hair = false;
  bool has_bag = false;
  Material jacket;
  Material trousers;
  Material skin;
  Material hair;
  Material shoes;
  Material bag;
};

// No two persons have the same clothes.
Look look_of(std::uint64_t seed);

// Metres forward in one whole step of the walking cycle: left and right foot once each.
float stride_m(const Look& look);

// A person that walks on a level floor, in the world: some 480 rectangles. `phase` counts whole
// strides, so that a walk at constant speed v has phase v t / stride; `position_m` is the point of
// the floor below the hips, and they walk along the heading (from the x axis towards the y axis).
std::vector<Rectangle> figure(const Look& look, float phase, const Eigen::Vector3f& position_m,
                              float heading_rad);

}  // namespace samewhere::twin
