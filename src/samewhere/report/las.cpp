#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string_view>

#include <Eigen/Geometry>

#include <samewhere/core/errors.hpp>
#include <samewhere/report/las.hpp>
#include <samewhere/report/little_endian.hpp>

namespace samewhere::report {
namespace {

constexpr std::uint16_t kLasHeaderBytes = 227;
constexpr std::uint16_t kLasPointBytes = 26;  // of format 2
constexpr double kFinestLasStep_m = 1e-4;

// How coordinates become whole numbers: (x - offset) / step.
struct LasGrid {
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
  double step_m = kFinestLasStep_m;
  Eigen::Vector3d min_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d max_m = Eigen::Vector3d::Zero();

  std::int32_t whole(double x_m, int axis) const {
    return static_cast<std::int32_t>(std::llround((x_m - offset_m(axis)) / step_m));
  }
};

LasGrid grid_of(const std::vector<ColouredPoint>& points) {
  LasGrid grid;
  if (points.empty()) return grid;
  Eigen::AlignedBox3d box;
  for (const ColouredPoint& point : points) box.extend(point.in_world.cast<double>());
  grid.min_m = box.min();
  grid.max_m = box.max();
  grid.offset_m = grid.min_m.array().floor();
  constexpr double kMostSteps = std::numeric_limits<std::int32_t>::max() - 1.0;
  grid.step_m = std::max(kFinestLasStep_m, (box.max() - grid.offset_m).maxCoeff() / kMostSteps);
  return grid;
}

void append_padded(std::string& bytes, std::string_view text, std::size_t num_bytes) {
  bytes += text;
  bytes.append(num_bytes - text.size(), '\0');
}

std::string las_header(const LasGrid& grid, std::uint32_t num_points) {
  std::string bytes = "LASF";
  bytes.append(20, '\0');  // source, encoding, project
  bytes += {'\1', '\2'};   // version
  append_padded(bytes, "OTHER", 32);
  append_padded(bytes, "samewhere", 32);
  bytes.append(4, '\0');  // date
  append_little_endian(bytes, kLasHeaderBytes);
  append_little_endian(bytes, std::uint32_t{kLasHeaderBytes});  // where points begin
  append_little_endian(bytes, std::uint32_t{0});                // variable records
  append_little_endian(bytes, std::uint8_t{2});                 // point format
  append_little_endian(bytes, kLasPointBytes);
  append_little_endian(bytes, num_points);
  for (const std::uint32_t count : {num_points, 0U, 0U, 0U, 0U})  // by number of the return
    append_little_endian(bytes, count);
  for (int axis = 0; axis < 3; ++axis) append_little_endian(bytes, grid.step_m);
  for (const double offset_m : grid.offset_m) append_little_endian(bytes, offset_m);
  for (int axis = 0; axis < 3; ++axis) {
    append_little_endian(bytes, grid.max_m(axis));
    append_little_endian(bytes, grid.min_m(axis));
  }
  core::require(bytes.size() == kLasHeaderBytes, "the header of a LAS 1.2 file has 227 bytes");
  return bytes;
}

void append_las_point(std::string& bytes, const ColouredPoint& point, const LasGrid& grid) {
  constexpr std::uint8_t kOnlyReturn = 1 | 1 << 3;  // number 1 of 1
  constexpr std::uint16_t kTo16Bits = 257;
  for (int axis = 0; axis < 3; ++axis)
    append_little_endian(bytes, grid.whole(point.in_world(axis), axis));
  append_little_endian(bytes, std::uint16_t{0});  // intensity
  append_little_endian(bytes, kOnlyReturn);
  bytes.append(5, '\0');  // class, scan angle, user data, source
  for (const std::uint8_t channel : point.rgb)
    append_little_endian(bytes, static_cast<std::uint16_t>(channel * kTo16Bits));
}

}  // namespace

std::string las_bytes(const std::vector<ColouredPoint>& points) {
  std::vector<ColouredPoint> finite;
  std::copy_if(points.begin(), points.end(), std::back_inserter(finite),
               [](const ColouredPoint& point) { return point.in_world.allFinite(); });
  const LasGrid grid = grid_of(finite);
  std::string bytes = las_header(grid, static_cast<std::uint32_t>(finite.size()));
  bytes.reserve(bytes.size() + finite.size() * kLasPointBytes);
  for (const ColouredPoint& point : finite) append_las_point(bytes, point, grid);
  return bytes;
}

}  // namespace samewhere::report
