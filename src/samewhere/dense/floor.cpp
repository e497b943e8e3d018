#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include <samewhere/core/median.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/dense/floor.hpp>
#include <samewhere/geometry/ransac.hpp>

namespace samewhere::dense {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kBand_m = 0.04;         // points so near to a plane belong to it
constexpr double kBelowCamera_m = 0.25;  // nearer than that under a camera is no floor
constexpr int kMaxSamplePoints = 20000;  // RANSAC looks at so many
constexpr double kMinLayerRatio = 0.25;  // a layer of a smaller share of the largest is no floor

Eigen::Vector3d mean_up(const core::Trajectory& cameras) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& camera : cameras) {
    sum -= camera.world_from_camera.rotation * Eigen::Vector3d::UnitY();
  }
  return sum.normalized();
}

// Median height of the cameras along `up`; without cameras 0.
double camera_height_m(const core::Trajectory& cameras, const Eigen::Vector3d& up) {
  std::vector<double> heights_m;
  for (const auto& camera : cameras) {
    heights_m.push_back(up.dot(camera.world_from_camera.translation));
  }
  return core::median(std::move(heights_m)).value_or(0.0);
}

Points points_below(const std::vector<CloudPoint>& cloud, const Eigen::Vector3d& up,
                    double height_m) {
  Points below;
  for (const CloudPoint& point : cloud) {
    const Eigen::Vector3d in_world = point.in_world.cast<double>();
    if (up.dot(in_world) < height_m - kBelowCamera_m) below.push_back(in_world);
  }
  return below;
}

// At most so many, evenly spread over the list.
Points sample_of(const Points& points, std::size_t max_size) {
  const std::size_t step = points.size() / max_size + 1;
  Points sample;
  for (std::size_t i = 0; i < points.size(); i += step) sample.push_back(points[i]);
  return sample;
}

struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset_m = 0.0;
};

// For geometry::ransac, whose errors are metres here.
struct HorizontalPlanes {
  using Model = Plane;
  static constexpr int kSampleSize = 3;

  const Points& points;
  Eigen::Vector3d up;
  double min_cosine;

  int size() const { return static_cast<int>(points.size()); }
  const Eigen::Vector3d& at(int i) const { return points[static_cast<std::size_t>(i)]; }

  std::vector<Plane> generate(const std::vector<int>& sample) const {
    const Eigen::Vector3d& a = at(sample[0]);
    const Eigen::Vector3d cross = (at(sample[1]) - a).cross(at(sample[2]) - a);
    if (cross.norm() < 1e-9) return {};
    Eigen::Vector3d normal = cross.normalized();
    if (normal.dot(up) < 0.0) normal = -normal;
    if (normal.dot(up) < min_cosine) return {};
    return {{normal, normal.dot(a)}};
  }
  double squared_error(const Plane& plane, int i) const {
    const double error_m = plane.normal.dot(at(i)) - plane.offset_m;
    return error_m * error_m;
  }
};

std::optional<Plane> largest_plane(const Points& points, const Eigen::Vector3d& up,
                                   const Config& config, std::uint64_t seed) {
  const Points sample = sample_of(points, kMaxSamplePoints);
  const HorizontalPlanes problem{sample, up, std::cos(config.max_floor_tilt_rad)};
  core::Random random(core::seed_of(seed, "floor", 0));
  const auto found = geometry::ransac(
      problem,
      {.max_error_px = kBand_m, .max_iterations = 1000, .confidence = 1.0, .min_inliers = 50},
      random);
  if (!found) return std::nullopt;
  return found->model;
}

// The lowest height along `up` at which a layer has enough points.
double lowest_layer_m(const Points& points, const Eigen::Vector3d& up) {
  double lowest_m = std::numeric_limits<double>::max();
  double highest_m = std::numeric_limits<double>::lowest();
  for (const auto& point : points) {
    lowest_m = std::min(lowest_m, up.dot(point));
    highest_m = std::max(highest_m, up.dot(point));
  }
  const auto num_bins = static_cast<std::size_t>((highest_m - lowest_m) / kBand_m) + 2;
  std::vector<int> counts(num_bins + 1, 0);
  for (const auto& point : points) {
    ++counts[static_cast<std::size_t>((up.dot(point) - lowest_m) / kBand_m)];
  }
  // a surface may lie on the border of two bins: look at pairs
  for (std::size_t i = 0; i < num_bins; ++i) counts[i] += counts[i + 1];
  const double min_count = kMinLayerRatio * *std::max_element(counts.begin(), counts.end() - 1);
  std::size_t layer = 0;
  while (counts[layer] < min_count) ++layer;
  // the pair that just reaches the share may hold the rim of the layer alone
  while (layer + 1 < num_bins && counts[layer + 1] > counts[layer]) ++layer;
  return lowest_m + static_cast<double>(layer + 1) * kBand_m;
}

// The plane of least squares through the points near a height, and how many they are.
std::pair<Plane, int> fitted(const Points& points, const Plane& near) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  int count = 0;
  for (const auto& point : points) {
    if (std::abs(near.normal.dot(point) - near.offset_m) > kBand_m) continue;
    sum += point;
    squares += point * point.transpose();
    ++count;
  }
  if (count < 3) return {near, count};
  const Eigen::Vector3d mean = sum / count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(squares / count -
                                                              mean * mean.transpose());
  Eigen::Vector3d normal = solver.eigenvectors().col(0);
  if (normal.dot(near.normal) < 0.0) normal = -normal;
  return {{normal, normal.dot(mean)}, count};
}

}  // namespace

Result<FloorPlane, std::string> find_floor(const std::vector<CloudPoint>& cloud, double voxel_m,
                                           const core::Trajectory& cameras, const Config& config,
                                           std::uint64_t seed) {
  const Eigen::Vector3d rough_up = mean_up(cameras);
  const Points below = points_below(cloud, rough_up, camera_height_m(cameras, rough_up));
  const auto largest = largest_plane(below, rough_up, config, seed);
  if (!largest) {
    return refuse(fmt::format("no plane among the {} points below the cameras", below.size()));
  }
  const Plane layer{largest->normal, lowest_layer_m(below, largest->normal)};
  const auto [first, num_first] = fitted(below, layer);
  const auto [plane, num_points] = fitted(below, first);
  const double area_m2 = num_points * voxel_m * voxel_m;
  if (area_m2 < config.min_floor_m2) {
    return refuse(
        fmt::format("the lowest level surface below the cameras has {:.2f} m2, a floor "
                    "has at least dense.min_floor_m2 = {}",
                    area_m2, config.min_floor_m2));
  }
  return FloorPlane{plane.normal, plane.offset_m, area_m2};
}

namespace {

// With its origin below a place.
core::Rigid3 map_below(const FloorPlane& floor, const Eigen::Vector3d& forward_in_world,
                       const Eigen::Vector3d& place_in_world) {
  const Eigen::Vector3d& up = floor.up_in_world;
  const Eigen::Vector3d forward = (forward_in_world - forward_in_world.dot(up) * up).normalized();
  Eigen::Matrix3d world_from_map;
  world_from_map << forward, up.cross(forward), up;
  return inverse(core::Rigid3{Eigen::Quaterniond(world_from_map),
                              place_in_world - (up.dot(place_in_world) - floor.offset_m) * up});
}

}  // namespace

core::Rigid3 map_on_floor(const FloorPlane& floor, const Eigen::Vector3d& forward_in_world) {
  return map_below(floor, forward_in_world, Eigen::Vector3d::Zero());
}

core::Rigid3 map_from_world(const FloorPlane& floor, const core::Rigid3& world_from_first_camera) {
  const Eigen::Vector3d& up = floor.up_in_world;
  const Eigen::Matrix3d axes = world_from_first_camera.rotation.toRotationMatrix();
  // a camera that looks straight down has its picture's top in front
  const Eigen::Vector3d looks =
      std::abs(axes.col(2).dot(up)) < 0.99 ? Eigen::Vector3d(axes.col(2)) : -axes.col(1);
  return map_below(floor, looks, world_from_first_camera.translation);
}

}  // namespace samewhere::dense
