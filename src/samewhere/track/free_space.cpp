#include <algorithm>
#include <limits>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/track/free_space.hpp>

namespace samewhere::track {
namespace {

constexpr int kCell_px = 8;

// 0: too much is unknown, so that something nearer may hide there.
float nearest_in(const cv::Mat& depth_m, const cv::Rect& cell) {
  constexpr int kMaxUnknown = kCell_px * kCell_px / 4;
  float nearest_m = std::numeric_limits<float>::max();
  int num_unknown = 0;
  for (int y = cell.y; y < cell.y + cell.height; ++y) {
    const float* row = depth_m.ptr<float>(y);
    for (int x = cell.x; x < cell.x + cell.width; ++x) {
      if (row[x] > 0.0F) {
        nearest_m = std::min(nearest_m, row[x]);
      } else {
        ++num_unknown;
      }
    }
  }
  return num_unknown > kMaxUnknown ? 0.0F : nearest_m;
}

}  // namespace

NearestSurface::NearestSurface(const cv::Mat& depth_m, const core::Camera& camera,
                               const FreeSpaceConfig& config)
    : camera_(camera),
      config_(config),
      nearest_m_(depth_m.rows / kCell_px, depth_m.cols / kCell_px, CV_32F) {
  for (int y = 0; y < nearest_m_.rows; ++y) {
    for (int x = 0; x < nearest_m_.cols; ++x)
      nearest_m_.at<float>(y, x) =
          nearest_in(depth_m, {x * kCell_px, y * kCell_px, kCell_px, kCell_px});
  }
}

bool NearestSurface::sees_through(const Eigen::Vector3d& point_in_camera) const {
  const auto pixel = geometry::project(camera_, point_in_camera);
  if (!pixel) return false;
  const int column = static_cast<int>(std::floor(pixel->x() / kCell_px));
  const int row = static_cast<int>(std::floor(pixel->y() / kCell_px));
  if (row < 1 || column < 1 || row + 1 >= nearest_m_.rows || column + 1 >= nearest_m_.cols)
    return false;
  const double behind_m = point_in_camera.z() * (1.0 + config_.margin_per_metre) + config_.margin_m;
  for (int y = row - 1; y <= row + 1; ++y) {
    for (int x = column - 1; x <= column + 1; ++x) {
      if (nearest_m_.at<float>(y, x) < behind_m) return false;
    }
  }
  return true;
}

}  // namespace samewhere::track
