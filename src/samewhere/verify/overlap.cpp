#include <algorithm>
#include <array>
#include <vector>

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

#include <samewhere/verify/overlap.hpp>
#include <samewhere/verify/pair_registration.hpp>

namespace samewhere::verify {
namespace {

constexpr std::size_t kMinPairs = 4;
constexpr int kRounds = 5;  // pairs of one epipolar line that are no pairs at all fall out

std::array<Eigen::Vector2d, 4> corners_of(const cv::Size& size_px) {
  const double width = size_px.width;
  const double height = size_px.height;
  return {{{0.0, 0.0}, {width, 0.0}, {width, height}, {0.0, height}}};
}

}  // namespace

double overlap_ratio(const geometry::PixelPairs& pairs, const cv::Size& first_size_px,
                     const cv::Size& second_size_px) {
  if (pairs.first_px.size() < kMinPairs) return 0.0;
  const auto laid = register_by_similarity(pairs, kRounds);
  if (!laid) return 0.0;
  std::vector<cv::Point2f> first;
  std::vector<cv::Point2f> second;
  for (const Eigen::Vector2d& corner : corners_of(first_size_px)) {
    const Eigen::Vector2d there = mapped(laid->second_from_first, corner);
    first.emplace_back(static_cast<float>(there.x()), static_cast<float>(there.y()));
  }
  for (const Eigen::Vector2d& corner : corners_of(second_size_px))
    second.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
  std::vector<cv::Point2f> both;
  const double shared = cv::intersectConvexConvex(first, second, both);
  const double area = std::max(cv::contourArea(first), cv::contourArea(second));
  return area > 0.0 ? std::min(1.0, shared / area) : 0.0;
}

}  // namespace samewhere::verify
