#pragma once

#include <cstdint>
#include <vector>

#include <samewhere/core/truth.hpp>
#include <samewhere/twin/surface.hpp>

namespace samewhere::twin {

inline constexpr double kFrameRate_hz = 15.0;

// Preset office-loop: a corridor 2 m wide and 2.6 m high around a block of offices, 16 m x 10 m
// outside, with doors that differ as much as `similarity` (in [0, 1]) leaves.
std::vector<Rectangle> office_loop_surfaces(std::uint64_t seed, double similarity);

// A walk once around it and a few metres on, along the middle of the corridor with rounded corners:
// the pose of the camera at every frame. z is up; the camera sways, bobs and looks around.
core::Trajectory office_loop_walk(std::uint64_t seed);

}  // namespace samewhere::twin
