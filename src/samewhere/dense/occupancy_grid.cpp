#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/dense/occupancy_grid.hpp>

namespace samewhere::dense {
namespace {

constexpr float kHit = 0.85F;  // log-odds of p = 0.7, 0.4, 0.12, 0.97
constexpr float kMiss = -0.4F;
constexpr float kLowest = -2.0F;
constexpr float kHighest = 3.5F;
constexpr float kOccupied = 1.0F;      // two hits: what one view alone saw may be noise
constexpr float kFree = -0.62F;        // two misses
constexpr double kMaxCells = 1 << 26;  // 9 bytes each
constexpr int kMargin_cells = 2;       // around all that was seen

// A scan in the frame of the map, without what is neither floor nor obstacle.
struct LevelScan {
  Eigen::Vector3f camera_in_map;
  std::vector<Eigen::Vector3f> points_in_map;
};

LevelScan leveled(const Scan& scan, const core::Rigid3& map_from_world, const Config& config) {
  const Eigen::Matrix3f rotation = map_from_world.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = map_from_world.translation.cast<float>();
  LevelScan level{rotation * scan.camera_in_world + translation, {}};
  for (const auto& in_world : scan.points_in_world) {
    const Eigen::Vector3f in_map = rotation * in_world + translation;
    const bool is_in_reach = in_map.z() >= -config.min_obstacle_m &&  // false for NaN
                             in_map.z() <= config.max_obstacle_m;
    if (is_in_reach) level.points_in_map.push_back(in_map);
  }
  return level;
}

// Casts scans into a grid that is large enough for all of them.
class GridCaster {
 public:
  GridCaster(OccupancyGrid& grid, const Config& config)
      : grid_(grid),
        min_obstacle_m_(static_cast<float>(config.min_obstacle_m)),
        bounds_(0, 0, grid.log_odds.cols, grid.log_odds.rows),
        top_m_(grid.log_odds.size(), CV_32F, cv::Scalar(0.0)),
        marks_(grid.log_odds.size(), CV_8U, cv::Scalar(kUntouched)) {}

  // Of all scans, before any is cast: how high the obstacles are.
  void note_tops(const LevelScan& scan) {
    for (const auto& point : scan.points_in_map) {
      if (point.z() < min_obstacle_m_) continue;
      auto& top_m = top_m_.at<float>(cell_of(point));
      top_m = std::max(top_m, point.z());
    }
  }

  void cast(const LevelScan& scan) {
    std::vector<cv::Point> hits;
    for (const auto& point : scan.points_in_map) {
      if (point.z() >= min_obstacle_m_) mark(cell_of(point), kHitMark, hits);
    }
    std::vector<cv::Point> misses;
    for (const auto& point : scan.points_in_map) walk(scan.camera_in_map, point, misses);
    settle(hits, kHit);
    settle(misses, kMiss);
  }

 private:
  enum Mark : std::uint8_t { kUntouched, kHitMark, kMissMark };

  cv::Point cell_of(const Eigen::Vector3f& in_map) const {
    const Eigen::Vector2d cell =
        ((in_map.head<2>().cast<double>() - grid_.corner_in_map) / grid_.cell_m).array().floor();
    return {static_cast<int>(cell.x()), static_cast<int>(cell.y())};
  }

  void mark(const cv::Point& cell, Mark mark, std::vector<cv::Point>& marked) {
    auto& known = marks_.at<std::uint8_t>(cell);
    if (known == kUntouched) marked.push_back(cell);
    if (known == kUntouched) known = mark;
  }

  // Misses the cells on the way, up to the first that this scan hits. One over which the ray passes
  // higher than anything in it says nothing of what stands there.
  void walk(const Eigen::Vector3f& camera, const Eigen::Vector3f& point,
            std::vector<cv::Point>& misses) {
    cv::LineIterator step(bounds_, cell_of(camera), cell_of(point));
    const float rise_m = (point.z() - camera.z()) / static_cast<float>(std::max(step.count - 1, 1));
    for (int i = 0; i < step.count; ++i, ++step) {
      const cv::Point cell = step.pos();
      if (marks_.at<std::uint8_t>(cell) == kHitMark) return;
      const float top_m = top_m_.at<float>(cell);
      const float height_m = camera.z() + static_cast<float>(i) * rise_m;
      if (top_m == 0.0F || height_m <= top_m) mark(cell, kMissMark, misses);
    }
  }

  void settle(const std::vector<cv::Point>& cells, float change) {
    for (const auto& cell : cells) {
      auto& log_odds = grid_.log_odds.at<float>(cell);
      log_odds = std::clamp(log_odds + change, kLowest, kHighest);
      marks_.at<std::uint8_t>(cell) = kUntouched;
    }
  }

  OccupancyGrid& grid_;
  float min_obstacle_m_;
  cv::Rect bounds_;
  cv::Mat top_m_;  // of all scans; 0: no obstacle was seen there
  cv::Mat marks_;  // of the scan that is cast
};

// What all scans reach, on the floor.
Eigen::AlignedBox2d extent_of(const std::vector<Scan>& scans, const core::Rigid3& map_from_world,
                              const Config& config) {
  Eigen::AlignedBox2d extent;
  for (const auto& scan : scans) {
    const LevelScan level = leveled(scan, map_from_world, config);
    extent.extend(level.camera_in_map.head<2>().cast<double>());
    for (const auto& point : level.points_in_map) extent.extend(point.head<2>().cast<double>());
  }
  return extent;
}

OccupancyGrid empty_grid(const Eigen::AlignedBox2d& extent, double cell_m) {
  const auto num_cells = [&] {
    return Eigen::Vector2d((extent.sizes() / cell_m).array().floor() + 1.0 + 2.0 * kMargin_cells);
  };
  while (num_cells().prod() > kMaxCells) cell_m *= 2.0;
  OccupancyGrid grid;
  grid.cell_m = cell_m;
  grid.corner_in_map = extent.min().array() - kMargin_cells * cell_m;
  grid.log_odds = cv::Mat(static_cast<int>(num_cells().y()), static_cast<int>(num_cells().x()),
                          CV_32F, cv::Scalar(0.0));
  return grid;
}

std::uint8_t grey_of(Cell cell) {
  constexpr std::uint8_t kGreys[] = {205, 254, 0};
  return kGreys[static_cast<int>(cell)];
}

}  // namespace

Cell OccupancyGrid::at(int row, int column) const {
  const float value = log_odds.at<float>(row, column);
  if (value > kOccupied) return Cell::kOccupied;
  return value < kFree ? Cell::kFree : Cell::kUnknown;
}

double OccupancyGrid::area_m2(Cell kind) const {
  int count = 0;
  for (int row = 0; row < log_odds.rows; ++row) {
    for (int column = 0; column < log_odds.cols; ++column) {
      if (at(row, column) == kind) ++count;
    }
  }
  return count * cell_m * cell_m;
}

OccupancyGrid cast_grid(const std::vector<Scan>& scans, const FloorPlane& floor,
                        const core::Rigid3& map_from_world, const Config& config) {
  core::require(!scans.empty(), "a grid is made of scans");
  OccupancyGrid grid = empty_grid(extent_of(scans, map_from_world, config), config.grid_cell_m);
  grid.map_from_world = map_from_world;
  grid.floor = floor;
  GridCaster caster(grid, config);
  for (const auto& scan : scans) caster.note_tops(leveled(scan, map_from_world, config));
  for (const auto& scan : scans) caster.cast(leveled(scan, map_from_world, config));
  return grid;
}

Result<OccupancyGrid, std::string> find_grid(const std::vector<Scan>& scans,
                                             const core::Trajectory& cameras,
                                             const Eigen::Vector3d& forward_in_world,
                                             const Config& config, std::uint64_t seed) {
  constexpr std::size_t kMaxScansForFloor = 100;
  const std::size_t step = scans.size() / kMaxScansForFloor + 1;
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < scans.size(); i += step)
    points.insert(points.end(), scans[i].points_in_world.begin(), scans[i].points_in_world.end());
  std::vector<CloudPoint> cloud;
  for (const Eigen::Vector3f& point : thinned(points, config.grid_cell_m))
    cloud.push_back({point, {}});
  const auto floor = find_floor(cloud, config.grid_cell_m, cameras, config, seed);
  if (!floor) return refuse(floor.error());
  return cast_grid(scans, *floor, map_on_floor(*floor, forward_in_world), config);
}

std::string pgm_bytes(const OccupancyGrid& grid) {
  std::string bytes = fmt::format("P5\n{} {}\n255\n", grid.log_odds.cols, grid.log_odds.rows);
  for (int row = grid.log_odds.rows - 1; row >= 0; --row) {
    for (int column = 0; column < grid.log_odds.cols; ++column) {
      bytes += static_cast<char>(grey_of(grid.at(row, column)));
    }
  }
  return bytes;
}

std::string map_yaml(const OccupancyGrid& grid, const std::string& image) {
  const Eigen::Vector3d& up = grid.floor.up_in_world;
  const Eigen::Vector3d& t = grid.map_from_world.translation;
  const Eigen::Quaterniond& q = grid.map_from_world.rotation;
  return fmt::format(
      "# floor in the world of the run: {:.6f} x + {:.6f} y + {:.6f} z = {:.4f} m (the normal is "
      "up), {:.1f} m2 of it were seen\n"
      "# map_from_world, tx ty tz qx qy qz qw: {:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}\n"
      "image: {}\n"
      "mode: trinary\n"
      "resolution: {}\n"
      "origin: [{:.6f}, {:.6f}, 0.0]\n"
      "negate: 0\n"
      "occupied_thresh: 0.65\n"
      "free_thresh: 0.196\n",
      up.x(), up.y(), up.z(), grid.floor.offset_m, grid.floor.area_m2, t.x(), t.y(), t.z(), q.x(),
      q.y(), q.z(), q.w(), nlohmann::json(image).dump(), grid.cell_m, grid.corner_in_map.x(),
      grid.corner_in_map.y());
}

}  // namespace samewhere::dense
