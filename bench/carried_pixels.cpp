#include "carried_pixels.hpp"

#include <algorithm>
#include <iterator>

#include <samewhere/geometry/camera.hpp>

namespace samewhere::bench {

std::optional<double> depth_between(const cv::Mat& depth_m, const Eigen::Vector2d& pixel) {
  constexpr double kSmooth = 0.02;
  const int x = static_cast<int>(std::floor(pixel.x()));
  const int y = static_cast<int>(std::floor(pixel.y()));
  if (x < 0 || y < 0 || x + 1 >= depth_m.cols || y + 1 >= depth_m.rows) return std::nullopt;
  const double a = pixel.x() - x;
  const double b = pixel.y() - y;
  const double corners[4] = {1.0 / depth_m.at<float>(y, x), 1.0 / depth_m.at<float>(y, x + 1),
                             1.0 / depth_m.at<float>(y + 1, x),
                             1.0 / depth_m.at<float>(y + 1, x + 1)};
  const auto [low, high] = std::minmax_element(std::begin(corners), std::end(corners));
  if (!(*high < (1.0 + kSmooth) * *low)) return std::nullopt;
  return 1.0 / ((1 - b) * ((1 - a) * corners[0] + a * corners[1]) +
                b * ((1 - a) * corners[2] + a * corners[3]));
}

std::vector<CarriedPixel> carried_pixels(const core::Camera& camera, const DepthView& from,
                                         const DepthView& to, int step_px) {
  const core::Rigid3 to_from_from = inverse(to.world_from_camera) * from.world_from_camera;
  std::vector<CarriedPixel> carried;
  for (int y = step_px; y + step_px < from.depth_m.rows; y += step_px) {
    for (int x = step_px; x + step_px < from.depth_m.cols; x += step_px) {
      const double depth_m = from.depth_m.at<float>(y, x);
      if (depth_m <= 0.0) continue;
      const Eigen::Vector2d pixel(x, y);
      const Eigen::Vector3d bearing = geometry::bearing(camera, pixel);
      const Eigen::Vector3d in_from = bearing / bearing.z() * depth_m;
      const Eigen::Vector3d in_to = to_from_from * in_from;
      const auto landed = geometry::project(camera, in_to);
      if (!landed) continue;
      const auto seen_m = depth_between(to.depth_m, *landed);
      if (seen_m) carried.push_back({pixel, *landed, in_to.z(), *seen_m});
    }
  }
  return carried;
}

}  // namespace samewhere::bench
