#include <algorithm>
#include <cmath>
#include <numbers>

#include <samewhere/evaluate/depth_places.hpp>
#include <samewhere/geometry/camera.hpp>

namespace samewhere::evaluate {
namespace {

constexpr std::size_t kMinPoints = 30;
// A point that the other view sees nearer or farther by more is another one.
constexpr double kMaxApart_m = 0.05;
constexpr double kMaxApartRatio = 0.04;

constexpr int kGrid = 24;
constexpr double kSameShare = 0.3;
constexpr double kDifferentShare = 0.05;
const double kSameCosine = std::cos(std::numbers::pi / 4.0);

using Points = std::vector<Eigen::Vector3d>;

core::PlaceTruth place_of(double there, double back, double cosine) {
  if (std::max(there, back) < kDifferentShare) return core::PlaceTruth::kDifferent;
  const bool is_same = std::min(there, back) >= kSameShare && cosine >= kSameCosine;
  return is_same ? core::PlaceTruth::kSame : core::PlaceTruth::kNear;
}

core::PlaceTruth compare(const DepthView& a, const Points& points_a, const DepthView& b,
                         const Points& points_b, const core::Camera& camera) {
  const core::Rigid3 b_from_a = inverse(b.world_from_camera) * a.world_from_camera;
  return place_of(share_seen(points_a, b_from_a, b.depth_m, camera),
                  share_seen(points_b, inverse(b_from_a), a.depth_m, camera),
                  (b_from_a.rotation * Eigen::Vector3d::UnitZ()).z());
}

}  // namespace

std::vector<Eigen::Vector3d> surface_points(const cv::Mat& depth_m, const core::Camera& camera,
                                            int grid) {
  Points points;
  for (int row = 0; row < grid; ++row) {
    for (int column = 0; column < grid; ++column) {
      const int x = (2 * column + 1) * depth_m.cols / (2 * grid);
      const int y = (2 * row + 1) * depth_m.rows / (2 * grid);
      const double z_m = depth_m.at<float>(y, x);
      if (z_m <= 0.0) continue;
      const Eigen::Vector3d bearing = geometry::bearing(camera, Eigen::Vector2d(x, y));
      points.push_back(bearing * (z_m / bearing.z()));
    }
  }
  return points;
}

double share_seen(const Points& points, const core::Rigid3& other_from_view,
                  const cv::Mat& other_depth_m, const core::Camera& camera) {
  if (points.size() < kMinPoints) return 0.0;
  int num_seen = 0;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d there = other_from_view * point;
    const auto pixel = geometry::project(camera, there);
    if (!pixel || pixel->x() < 0.0 || pixel->y() < 0.0 || pixel->x() > other_depth_m.cols - 1.0 ||
        pixel->y() > other_depth_m.rows - 1.0)
      continue;
    const double seen_m = other_depth_m.at<float>(static_cast<int>(std::lround(pixel->y())),
                                                  static_cast<int>(std::lround(pixel->x())));
    if (seen_m > 0.0 && std::abs(seen_m - there.z()) <= kMaxApart_m + kMaxApartRatio * there.z())
      ++num_seen;
  }
  return static_cast<double>(num_seen) / static_cast<double>(points.size());
}

core::PlaceTruthMatrix places_from_depth(const std::vector<std::optional<DepthView>>& frames,
                                         const core::Camera& camera) {
  const std::size_t n = frames.size();
  core::PlaceTruthMatrix places{static_cast<int>(n),
                                std::vector<core::PlaceTruth>(n * n, core::PlaceTruth::kNear)};
  std::vector<Points> points(n);
  for (std::size_t i = 0; i < n; ++i) {
    places.values[i * n + i] = core::PlaceTruth::kSame;
    if (!frames[i]) continue;
    points[i] = surface_points(frames[i]->depth_m, camera, kGrid);
    for (std::size_t k = 0; k < i; ++k) {
      if (!frames[k]) continue;
      const core::PlaceTruth place = compare(*frames[i], points[i], *frames[k], points[k], camera);
      places.values[i * n + k] = place;
      places.values[k * n + i] = place;
    }
  }
  return places;
}

}  // namespace samewhere::evaluate
