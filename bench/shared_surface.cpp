#include "shared_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <samewhere/evaluate/depth_places.hpp>

namespace samewhere::bench {
namespace {

constexpr int kCoarseGrid = 24;  // rows and columns
constexpr int kFineGrid = 96;    // of the kNumLooked likeliest by the coarse one
constexpr std::size_t kNumLooked = 30;
// The same place: so much is shared, and both look so much the same way.
constexpr double kSameShare = 0.3;
constexpr double kSameAngle_rad = std::numbers::pi / 4.0;
// How far poses of a few centimetres and a degree or two let either be off: set beforehand.
constexpr double kShareSigma = 0.05;
constexpr double kAngleSigma_rad = 2.0 * std::numbers::pi / 180.0;

using Points = std::vector<Eigen::Vector3d>;

// Of a normal number with mean `value` to be larger than `bar`.
double likeliness_above(double value, double bar, double sigma) {
  return 0.5 * std::erfc((bar - value) / (sigma * std::numbers::sqrt2));
}

}  // namespace

SurfaceView surface_view(int frame, const cv::Mat& depth_m, const core::Camera& camera) {
  return {.frame = frame,
          .seen = {depth_m, {}},
          .coarse = evaluate::surface_points(depth_m, camera, kCoarseGrid),
          .fine = evaluate::surface_points(depth_m, camera, kFineGrid)};
}

SharedSurface shared_surface(const SurfaceView& a, const SurfaceView& b, const core::Camera& camera,
                             Points SurfaceView::*points) {
  const core::Rigid3 b_from_a = inverse(b.seen.world_from_camera) * a.seen.world_from_camera;
  const double cosine = (b_from_a.rotation * Eigen::Vector3d::UnitZ()).z();
  const double angle_rad = std::acos(std::clamp(cosine, -1.0, 1.0));
  if (angle_rad > 2.0 * kSameAngle_rad) return {};
  const double there = evaluate::share_seen(a.*points, b_from_a, b.seen.depth_m, camera);
  const double back = evaluate::share_seen(b.*points, inverse(b_from_a), a.seen.depth_m, camera);
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
