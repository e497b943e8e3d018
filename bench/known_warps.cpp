#include "known_warps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

#include <samewhere/core/random.hpp>
#include <samewhere/features/match_pair.hpp>

namespace samewhere::bench {
namespace {

constexpr double kMaxError_px = 3.0;
constexpr double kMargin_px = 20.0;  // no extractor detects features nearer to the edge
constexpr double kNoise_levels = 2.0;

// Turned about the centre and scaled, and its far edge drawn together by `tilt`.
cv::Matx33d about_centre(const cv::Size& size_px, double angle_deg, double scale, double tilt) {
  const double x = 0.5 * (size_px.width - 1);
  const double y = 0.5 * (size_px.height - 1);
  const double angle_rad = angle_deg * std::numbers::pi / 180.0;
  const double c = scale * std::cos(angle_rad);
  const double s = scale * std::sin(angle_rad);
  const cv::Matx33d from_centre(1, 0, x, 0, 1, y, 0, 0, 1);
  const cv::Matx33d to_centre(1, 0, -x, 0, 1, -y, 0, 0, 1);
  return from_centre * cv::Matx33d(c, -s, 0, s, c, 0, tilt / size_px.width, 0, 1) * to_centre;
}

cv::Point2d moved(const cv::Matx33d& homography, const cv::Point2f& point) {
  const cv::Vec3d image = homography * cv::Vec3d(point.x, point.y, 1.0);
  return {image[0] / image[2], image[1] / image[2]};
}

bool is_inside(const cv::Point2d& point, const cv::Size& size_px) {
  return point.x >= kMargin_px && point.y >= kMargin_px && point.x < size_px.width - kMargin_px &&
         point.y < size_px.height - kMargin_px;
}

double distance_px(const cv::Point2d& a, const cv::Point2f& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

}  // namespace

std::vector<Warp> known_warps(const cv::Size& size_px) {
  const auto view = [&](double angle_deg, double scale, double tilt) {
    return about_centre(size_px, angle_deg, scale, tilt);
  };
  std::vector<Warp> warps = {
      {"turned 10 deg", view(10, 1, 0)},     {"turned 45 deg", view(45, 1, 0)},
      {"1.3 times nearer", view(3, 1.3, 0)}, {"1.5 times further", view(-3, 1 / 1.5, 0)},
      {"from the side", view(5, 0.95, 0.4)}, {"darker, flatter", view(2, 1, 0), 0.5, -30},
      {"brighter", view(2, 1, 0), 1.3, 30}};
  for (auto& warp : warps) warp.noise_levels = kNoise_levels;
  return warps;
}

cv::Mat warped(const cv::Mat& grey, const Warp& warp, std::uint64_t seed) {
  cv::Mat second;
  cv::warpPerspective(grey, second, warp.second_from_first, grey.size(), cv::INTER_LINEAR,
                      cv::BORDER_REFLECT_101);
  core::Random random(seed);
  for (int y = 0; y < second.rows; ++y) {
    for (int x = 0; x < second.cols; ++x) {
      auto& pixel = second.at<std::uint8_t>(y, x);
      pixel =
          cv::saturate_cast<std::uint8_t>(128.0 + warp.contrast * (pixel - 128.0) +
                                          warp.brightness + warp.noise_levels * random.gaussian());
    }
  }
  return second;
}

Repeat find_again(const PointTable& first, const PointTable& second, const Warp& warp,
                  const cv::Size& size_px) {
  Repeat repeat;
  for (const auto& point : first.points_px) {
    const cv::Point2d there = moved(warp.second_from_first, point);
    if (!is_inside(there, size_px)) continue;
    ++repeat.num_visible;
    repeat.num_again +=
        std::any_of(second.points_px.begin(), second.points_px.end(),
                    [&](const auto& other) { return distance_px(there, other) <= kMaxError_px; });
  }
  constexpr int kNoLimit_bits = 256;
  for (const auto& match : features::match_pair(first.descriptors, second.descriptors,
                                                {.max_distance_bits = kNoLimit_bits})) {
    const double error_px = distance_px(
        moved(warp.second_from_first, first.points_px[static_cast<std::size_t>(match.first)]),
        second.points_px[static_cast<std::size_t>(match.second)]);
    ++repeat.num_matches;
    if (error_px > kMaxError_px) continue;
    ++repeat.num_right;
    repeat.errors_px.push_back(error_px);
  }
  return repeat;
}

}  // namespace samewhere::bench
