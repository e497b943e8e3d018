#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <samewhere/core/result.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/core/truth.hpp>
#include <samewhere/dense/config.hpp>
#include <samewhere/dense/voxel_cloud.hpp>

namespace samewhere::dense {

struct FloorPlane {
  Eigen::Vector3d up_in_world = Eigen::Vector3d::UnitZ();  // unit
  double offset_m = 0.0;  // height of a point x above the floor: up_in_world . x - offset_m
  double area_m2 = 0.0;   // of it, as much as was seen
};

// Detects the floor, or gives the reason why there is none. The mean up direction of the cameras is
// the prior; RANSAC finds the largest plane of about that normal among the points below the
// cameras; of the surfaces at one height under that normal, the floor is the lowest with at least a
// quarter of the points of the largest, so that a long table is not taken for it. A single plane:
// with stairs or ramps the largest level surface is found. `voxel_m` is the voxel size of the
// cloud.
Result<FloorPlane, std::string> find_floor(const std::vector<CloudPoint>& cloud, double voxel_m,
                                           const core::Trajectory& cameras, const Config& config,
                                           std::uint64_t seed);

// The frame of a map that stands on the floor: z up, origin below the first camera, x where that
// camera looked.
core::Rigid3 map_from_world(const FloorPlane& floor, const core::Rigid3& world_from_first_camera);

// The same with x along `forward_in_world`, which is not upright, and the origin below that of the
// world.
core::Rigid3 map_on_floor(const FloorPlane& floor, const Eigen::Vector3d& forward_in_world);

}  // namespace samewhere::dense
