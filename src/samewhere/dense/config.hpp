#pragma once

#include <samewhere/core/config.hpp>

namespace samewhere::dense {

struct Config {
  int step_px = 2;
  double min_depth_m = 0.3;
  double max_depth_m = 4.0;
  double max_jump_ratio = 0.05;
  double voxel_m = 0.02;
  int max_voxels = 4000000;
  int min_views = 2;
  double octree_voxel_m = 0.05;
  double grid_cell_m = 0.05;
  int max_scan_points = 20000000;
  double min_obstacle_m = 0.1;
  double max_obstacle_m = 1.8;
  double max_floor_tilt_rad = 0.6;
  double min_floor_m2 = 0.5;
};

inline void visit_surfaces(Config& config, core::FieldVisitor& visit) {
  visit("step_px", config.step_px,
        {.help = "sampling step over the depth image, pixels", .min = 1, .max = 64});
  visit("min_depth_m", config.min_depth_m,
        {.help = "nearest depth used, metres", .min = 0.01, .max = 100.0});
  visit("max_depth_m", config.max_depth_m,
        {.help = "farthest depth used, metres", .min = 0.1, .max = 100.0});
  visit("max_jump_ratio", config.max_jump_ratio,
        {.help = "pixels with a relative depth step above this to a neighbour are not used",
         .min = 0.001,
         .max = 10.0});
  visit("voxel_m", config.voxel_m,
        {.help = "edge of the voxels of the point cloud, metres", .min = 0.001, .max = 10.0});
  visit("max_voxels", config.max_voxels,
        {.help = "largest number of voxels (100 bytes each); above, the edge doubles",
         .min = 1000,
         .max = 1e9});
  visit(
      "min_views", config.min_views,
      {.help = "least keyframes that observed a voxel of the point cloud", .min = 1, .max = 1000});
}

inline void visit_maps(Config& config, core::FieldVisitor& visit) {
  visit("octree_voxel_m", config.octree_voxel_m,
        {.help = "edge of the smallest octree voxels, metres", .min = 0.005, .max = 10.0});
  visit("grid_cell_m", config.grid_cell_m,
        {.help = "edge of the occupancy grid cells, metres", .min = 0.01, .max = 10.0});
  visit("max_scan_points", config.max_scan_points,
        {.help = "largest number of points (12 bytes each) for the grid; above, every other "
                 "keyframe is dropped",
         .min = 1000,
         .max = 1e9});
  visit("min_obstacle_m", config.min_obstacle_m,
        {.help = "least height of an obstacle above the floor, metres", .min = 0.01, .max = 10.0});
  visit(
      "max_obstacle_m", config.max_obstacle_m,
      {.help = "largest height of an obstacle above the floor, metres", .min = 0.02, .max = 100.0});
  visit("max_floor_tilt_rad", config.max_floor_tilt_rad,
        {.help = "largest angle between the floor's normal and the mean up direction of the "
                 "images, radians",
         .min = 0.01,
         .max = 1.5});
  visit("min_floor_m2", config.min_floor_m2,
        {.help = "least area of the floor, square metres", .min = 0.01, .max = 1e4});
}

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit_surfaces(config, visit);
  visit_maps(config, visit);
}

}  // namespace samewhere::dense
