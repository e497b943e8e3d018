#include "view_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/median.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/geometry/camera.hpp>

namespace samewhere::bench {
namespace {

constexpr int kPointStep_px = 16;
constexpr double kDepthTolerance_m = 0.05;
constexpr double kDepthToleranceRatio = 0.04;
constexpr double kMinOverlap = 0.3;
constexpr int kDrawsPerPair = 20;
constexpr std::uint64_t kSeed = 0;

double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::numbers::pi;
}

double depth_at(const cv::Mat& grid_m, const Eigen::Vector2d& pixel) {
  const long column = std::lround(pixel.x() / kDepthStep_px);
  const long row = std::lround(pixel.y() / kDepthStep_px);
  const bool is_inside = column >= 0 && row >= 0 && column < grid_m.cols && row < grid_m.rows;
  return is_inside ? grid_m.at<float>(static_cast<int>(row), static_cast<int>(column)) : -1.0;
}

cv::Mat thinned(const cv::Mat& depth_m) {
  cv::Mat grid((depth_m.rows + kDepthStep_px - 1) / kDepthStep_px,
               (depth_m.cols + kDepthStep_px - 1) / kDepthStep_px, CV_32F);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.cols; ++column) {
      grid.at<float>(row, column) = depth_m.at<float>(row * kDepthStep_px, column * kDepthStep_px);
    }
  }
  return grid;
}

void add_points(ViewGeometry& view) {
  constexpr int kStep = kPointStep_px / kDepthStep_px;
  std::vector<double> depths_m;
  for (int row = kStep / 2; row < view.depth_m.rows; row += kStep) {
    for (int column = kStep / 2; column < view.depth_m.cols; column += kStep) {
      const double depth_m = view.depth_m.at<float>(row, column);
      if (depth_m <= 0.0) continue;
      const Eigen::Vector3d ray = geometry::bearing(
          view.camera, Eigen::Vector2d(column * kDepthStep_px, row * kDepthStep_px));
      view.points_in_camera.push_back(ray * (depth_m / ray.z()));
      depths_m.push_back(depth_m);
    }
  }
  view.median_depth_m = core::median(depths_m).value_or(0.0);
}

// Index of the interval that holds the value, or -1.
int interval_of(double value, const std::array<double, 6>& limits) {
  const auto above = std::upper_bound(limits.begin(), limits.end(), value);
  const bool is_inside = above != limits.begin() && above != limits.end();
  return is_inside ? static_cast<int>(above - limits.begin()) - 1 : -1;
}

using Candidates = std::array<std::vector<std::pair<int, int>>, kNumClasses>;

Candidates pairs_by_class(const std::vector<ViewGeometry>& views, Way way) {
  Candidates candidates;
  const int num_views = static_cast<int>(views.size());
  for (int first = 0; first < num_views; ++first) {
    for (int second = first + 1; second < num_views; ++second) {
      const ViewGeometry& a = views[static_cast<std::size_t>(first)];
      const ViewGeometry& b = views[static_cast<std::size_t>(second)];
      const int found = pair_class(a, b);
      if (found < 0 || !goes(way, a, b)) continue;
      candidates[static_cast<std::size_t>(found)].emplace_back(first, second);
    }
  }
  return candidates;
}

std::vector<ViewPair> draw(std::vector<std::pair<int, int>> candidates,
                           const std::vector<ViewGeometry>& views, int max_pairs,
                           core::Random& random) {
  std::vector<ViewPair> drawn;
  const std::size_t num_draws =
      std::min(candidates.size(), static_cast<std::size_t>(kDrawsPerPair * max_pairs));
  for (std::size_t i = 0; i < num_draws && static_cast<int>(drawn.size()) < max_pairs; ++i) {
    std::swap(candidates[i], candidates[i + random.index(candidates.size() - i)]);
    const auto [first, second] = candidates[i];
    const ViewGeometry& a = views[static_cast<std::size_t>(first)];
    const ViewGeometry& b = views[static_cast<std::size_t>(second)];
    const SharedView there = shared_view(a, b);
    const SharedView back = shared_view(b, a);
    const double overlap = std::min(there.overlap, back.overlap);
    if (overlap < kMinOverlap) continue;
    drawn.push_back({first, second, overlap, 0.5 * (there.parallax_deg + back.parallax_deg)});
  }
  return drawn;
}

}  // namespace

ViewGeometry view_geometry(const core::Frame& frame, const core::Rigid3& world_from_camera) {
  core::require(frame.rig && frame.rig->is_calibrated() && frame.depth_m,
                "the geometry of a view comes from a calibrated camera with depth");
  ViewGeometry view{.world_from_camera = world_from_camera,
                    .camera = frame.rig->cameras.front(),
                    .depth_m = thinned(*frame.depth_m),
                    .points_in_camera = {}};
  add_points(view);
  return view;
}

SharedView shared_view(const ViewGeometry& first, const ViewGeometry& second) {
  const core::Rigid3 second_from_first =
      core::inverse(second.world_from_camera) * first.world_from_camera;
  int num_known = 0;
  std::vector<double> parallaxes_deg;
  for (const Eigen::Vector3d& point : first.points_in_camera) {
    const Eigen::Vector3d point_in_second = second_from_first * point;
    const auto pixel = geometry::project(second.camera, point_in_second);
    const double depth_m = pixel ? depth_at(second.depth_m, *pixel) : -1.0;
    if (depth_m == 0.0) continue;
    ++num_known;
    const double tolerance_m = kDepthTolerance_m + kDepthToleranceRatio * depth_m;
    if (depth_m < 0.0 || std::abs(depth_m - point_in_second.z()) > tolerance_m) continue;
    parallaxes_deg.push_back(angle_deg(second_from_first.rotation * point, point_in_second));
  }
  if (parallaxes_deg.empty()) return {};
  return {.overlap = static_cast<double>(parallaxes_deg.size()) / num_known,
          .parallax_deg = core::median(parallaxes_deg).value_or(0.0)};
}

bool goes(Way way, const ViewGeometry& first, const ViewGeometry& second) {
  if (way == Way::kAny) return true;
  const core::Rigid3& a = first.world_from_camera;
  const core::Rigid3& b = second.world_from_camera;
  const Eigen::Vector3d ahead =
      a.rotation * Eigen::Vector3d::UnitZ() + b.rotation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d baseline = b.translation - a.translation;
  const double along = std::abs(ahead.dot(baseline));
  const bool is_forward = along > std::numbers::sqrt2 / 2.0 * ahead.norm() * baseline.norm();
  return is_forward == (way == Way::kForward);
}

int pair_class(const ViewGeometry& first, const ViewGeometry& second) {
  const double depth_m = 0.5 * (first.median_depth_m + second.median_depth_m);
  if (depth_m <= 0.0) return -1;
  const core::Rigid3& a = first.world_from_camera;
  const core::Rigid3& b = second.world_from_camera;
  const Eigen::Vector3d forward = Eigen::Vector3d::UnitZ();
  const int baseline =
      interval_of((a.translation - b.translation).norm() / depth_m, kBaselineRatios);
  const int angle = interval_of(angle_deg(a.rotation * forward, b.rotation * forward), kAngles_deg);
  return baseline < 0 || angle < 0 ? -1 : 5 * baseline + angle;
}

std::string class_name(int pair_class) {
  const auto baseline = static_cast<std::size_t>(pair_class / 5);
  const auto angle = static_cast<std::size_t>(pair_class % 5);
  return fmt::format("t {}-{}, {}-{} deg", kBaselineRatios[baseline], kBaselineRatios[baseline + 1],
                     kAngles_deg[angle], kAngles_deg[angle + 1]);
}

std::array<std::vector<ViewPair>, kNumClasses> draw_pairs(const std::vector<ViewGeometry>& views,
                                                          Way way, int max_pairs) {
  const Candidates candidates = pairs_by_class(views, way);
  std::array<std::vector<ViewPair>, kNumClasses> drawn;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    core::Random random(core::seed_of(kSeed, "view pairs", i));
    drawn[i] = draw(candidates[i], views, max_pairs, random);
  }
  return drawn;
}

}  // namespace samewhere::bench
