#include "shared_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <samewhere/geometry/camera.hpp>

namespace samewhere::bench {
namespace {

constexpr int kCoarseGrid = 24;  // rows and columns
constexpr int kFineGrid = 96;    // of the kNumLooked likeliest by the coarse one
constexpr std::size_t kNumLooked = 30;
constexpr std::size_t kMinPoints = 30;
// A point that the other view sees nearer or farther by more is another one.
constexpr double kMaxApart_m = 0.05;
constexpr double kMaxApartRatio = 0.04;
// The same place: so much is shared, and both look so much the same way.
constexpr double kSameShare = 0.3;
constexpr double kSameAngle_rad = std::numbers::pi / 4.0;
// How far poses of a few centimetres and a degree or two let either be off: set beforehand.
constexpr double kShareSigma = 0.05;
constexpr double kAngleSigma_rad = 2.0 * std::numbers::pi / 180.0;

using Points = std::vector<Eigen::Vector3d>;

Points points_of(const cv::Mat& depth_m, const core::Camera& camera, int grid) {
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

// Of the points that one view shows, so many are seen by the other.
double share_seen(const Points& points, const core::Rigid3& other_from_view, const cv::Mat& depth_m,
                  const core::Camera& camera) {
  if (points.size() < kMinPoints) return 0.0;
  int num_seen = 0;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d there = other_from_view * point;
    const auto pixel = geometry::project(camera, there);
    if (!pixel || pixel->x() < 0.0 || pixel->y() < 0.0 || pixel->x() > depth_m.cols - 1.0 ||
        pixel->y() > depth_m.rows - 1.0)
      continue;
    const double seen_m = depth_m.at<float>(static_cast<int>(std::lround(pixel->y())),
                                            static_cast<int>(std::lround(pixel->x())));
    if (seen_m > 0.0 && std::abs(seen_m - there.z()) <= kMaxApart_m + kMaxApartRatio * there.z())
      ++num_seen;
  }
  return static_cast<double>(num_seen) / static_cast<double>(points.size());
}

// Of a normal number with mean `value` to be larger than `bar`.
double likeliness_above(double value, double bar, double sigma) {
  return 0.5 * std::erfc((bar - value) / (sigma * std::numbers::sqrt2));
}

}  // namespace

SurfaceView surface_view(int frame, const cv::Mat& depth_m, const core::Camera& camera) {
  return {.frame = frame,
          .seen = {depth_m, {}},
          .coarse = points_of(depth_m, camera, kCoarseGrid),
          .fine = points_of(depth_m, camera, kFineGrid)};
}

SharedSurface shared_surface(const SurfaceView& a, const SurfaceView& b, const core::Camera& camera,
                             Points SurfaceView::*points) {
  const core::Rigid3 b_from_a = inverse(b.seen.world_from_camera) * a.seen.world_from_camera;
  const double cosine = (b_from_a.rotation * Eigen::Vector3d::UnitZ()).z();
  const double angle_rad = std::acos(std::clamp(cosine, -1.0, 1.0));
  if (angle_rad > 2.0 * kSameAngle_rad) return {};
  const double there = share_seen(a.*points, b_from_a, b.seen.depth_m, camera);
  const double back = share_seen(b.*points, inverse(b_from_a), a.seen.depth_m, camera);
  return {.share = std::min(there, back),
          .likeliness = likeliness_above(there, kSameShare, kShareSigma) *
                        likeliness_above(back, kSameShare, kShareSigma) *
                        likeliness_above(-angle_rad, -kSameAngle_rad, kAngleSigma_rad)};
}

std::vector<evaluate::Match> places_by_surface(const std::vector<SurfaceView>& views,
                                               const core::Camera& camera, int window_frames) {
  std::vector<evaluate::Match> matches;
  for (const SurfaceView& view : views) {
    std::vector<std::pair<SharedSurface, const SurfaceView*>> looked;
    for (const SurfaceView& earlier : views) {
      if (view.frame - earlier.frame <= window_frames) break;
      const SharedSurface shared = shared_surface(view, earlier, camera, &SurfaceView::coarse);
      if (shared.share > 0.0) looked.emplace_back(shared, &earlier);
    }
    if (looked.empty()) continue;
    const auto is_likelier = [](const auto& a, const auto& b) {
      return a.first.likeliness > b.first.likeliness;
    };
    std::stable_sort(looked.begin(), looked.end(), is_likelier);
    if (looked.size() > kNumLooked) looked.resize(kNumLooked);
    for (auto& [shared, earlier] : looked)
      shared = shared_surface(view, *earlier, camera, &SurfaceView::fine);
    const auto& [shared, earlier] = *std::min_element(looked.begin(), looked.end(), is_likelier);
    matches.push_back({view.frame, earlier->frame, shared.share});
  }
  return matches;
}

}  // namespace samewhere::bench
