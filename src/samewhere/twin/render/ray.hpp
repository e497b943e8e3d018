#pragma once

#include <optional>

#include <samewhere/twin/building/surface.hpp>

namespace samewhere::twin {

struct Ray {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();      // metres
  Eigen::Vector3f direction = Eigen::Vector3f::UnitX();  // of any length
};

// A ray does not meet the surface that it starts on: in lengths of the direction.
inline constexpr float kMinReach = 1e-5F;

// Where the ray meets the plane of the rectangle, in lengths of the direction; not finite if it
// runs along it.
float reach_of_plane(const Ray& ray, const Rectangle& rectangle);

// Where the ray meets the rectangle, in lengths of the direction; nothing if it misses it.
std::optional<float> reach_of(const Ray& ray, const Rectangle& rectangle);

}  // namespace samewhere::twin
