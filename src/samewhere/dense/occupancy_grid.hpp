#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <samewhere/core/result.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/dense/config.hpp>
#include <samewhere/dense/floor.hpp>
#include <samewhere/dense/scans.hpp>

namespace samewhere::dense {

enum class Cell { kUnknown, kFree, kOccupied };

// A 2D occupancy grid on the floor.
struct OccupancyGrid {
  double cell_m = 0.0;
  Eigen::Vector2d corner_in_map = Eigen::Vector2d::Zero();  // of the cell (0, 0), metres
  core::Rigid3 map_from_world;
  FloorPlane floor;
  cv::Mat log_odds;  // of being occupied, 32-bit float; row = y, ascending; column = x

  Cell at(int row, int column) const;
  // Area of the cells of this state, square metres.
  double area_m2(Cell kind) const;
};

// Where a robot on the floor could go: per scan, the cells with a point between min_obstacle_m and
// max_obstacle_m above the floor are hit, and those on the straight ways from the camera to points
// on the floor or in that band are missed, up to the first that is hit; but no ray misses a cell
// above all that was ever seen in it, or looking over a table would clear it. Each scan adds once
// to a cell's log-odds (Moravec and Elfes 1985, weights of OctoMap); two hits more than misses make
// a cell occupied. Cells are of config.grid_cell_m, doubled until at most 2^26 make the plan.
OccupancyGrid cast_grid(const std::vector<Scan>& scans, const FloorPlane& floor,
                        const core::Rigid3& map_from_world, const Config& config);

// The same for scans alone, in a map whose x axis points along `forward_in_world` and whose origin
// is below that of the world. The floor is looked for among the points of at most a hundred scans;
// `cameras`: where each was taken from. Without a floor: why.
Result<OccupancyGrid, std::string> find_grid(const std::vector<Scan>& scans,
                                             const core::Trajectory& cameras,
                                             const Eigen::Vector3d& forward_in_world,
                                             const Config& config, std::uint64_t seed);

// The two files of a map server's map. The picture, PGM: first row = largest y; 0 occupied, 254
// free, 205 unknown.
std::string pgm_bytes(const OccupancyGrid& grid);
// Where it lies, YAML; comments tell the floor in the world of the run. `image` is the picture's
// name.
std::string map_yaml(const OccupancyGrid& grid, const std::string& image);

}  // namespace samewhere::dense
