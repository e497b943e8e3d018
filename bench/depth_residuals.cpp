#include "depth_residuals.hpp"

#include <algorithm>
#include <cmath>
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

std::vector<double> depth_residuals(const core::Camera& camera, const DepthView& from,
                                    const DepthView& to) {
  constexpr int kStep_px = 12;
  const core::Rigid3 to_from_from = inverse(to.world_from_camera) * from.world_from_camera;
  std::vector<double> residuals;
  for (int y = kStep_px; y + kStep_px < from.depth_m.rows; y += kStep_px) {
    for (int x = kStep_px; x + kStep_px < from.depth_m.cols; x += kStep_px) {
      const double depth_m = from.depth_m.at<float>(y, x);
      if (depth_m <= 0.0) continue;
      const Eigen::Vector3d bearing = geometry::bearing(camera, {x, y});
      const Eigen::Vector3d in_to = to_from_from * Eigen::Vector3d(bearing / bearing.z() * depth_m);
      const auto pixel = geometry::project(camera, in_to);
      if (!pixel) continue;
      const auto seen_m = depth_between(to.depth_m, *pixel);
      if (seen_m) residuals.push_back(std::abs(*seen_m / in_to.z() - 1.0));
    }
  }
  return residuals;
}

}  // namespace samewhere::bench
