#include <fmt/format.h>

#include <samewhere/report/little_endian.hpp>
#include <samewhere/report/ply.hpp>

namespace samewhere::report {

std::string ply_bytes(const std::vector<ColouredPoint>& points) {
  std::string vertices;
  int num_vertices = 0;
  for (const ColouredPoint& point : points) {
    if (!point.in_world.allFinite()) continue;
    ++num_vertices;
    for (const float coordinate : point.in_world) append_little_endian(vertices, coordinate);
    for (const std::uint8_t channel : point.rgb) append_little_endian(vertices, channel);
  }
  return fmt::format(
             "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
             "property float x\nproperty float y\nproperty float z\n"
             "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
             num_vertices) +
         vertices;
}

}  // namespace samewhere::report
