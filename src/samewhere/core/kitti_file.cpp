#include <iterator>

#include <fmt/format.h>

#include <samewhere/core/kitti_file.hpp>

namespace samewhere::core {

std::string kitti_text(const Trajectory& trajectory) {
  std::string text;
  for (const StampedPose& pose : trajectory) {
    const Eigen::Matrix4d matrix = pose.world_from_camera.matrix();
    for (int i = 0; i < 12; ++i) {
      fmt::format_to(std::back_inserter(text), "{:.9f}{}", matrix(i / 4, i % 4),
                     i == 11 ? '\n' : ' ');
    }
  }
  return text;
}

}  // namespace samewhere::core
