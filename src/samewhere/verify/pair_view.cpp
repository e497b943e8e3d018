#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/features/hamming.hpp>
#include <samewhere/features/match_pair.hpp>
#include <samewhere/geometry/two_view.hpp>
#include <samewhere/verify/epipolar.hpp>
#include <samewhere/verify/pair_registration.hpp>
#include <samewhere/verify/pair_view.hpp>

namespace samewhere::verify {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using features::Features;
using features::Match;

constexpr double kMinOverlapRatio = 0.1;
constexpr double kLightSigma_px = 6.0;  // of a plane: light changes more slowly than that
constexpr double kContrastFloor = 6.0;  // grey levels: noise of a bare wall is not made large
constexpr double kMaxContrast = 3.0;    // standard deviations, beyond: clipped
constexpr double kDotSigma_px = 1.2;    // of a plane
constexpr int kAlikeShift_px = 3;       // of a plane
constexpr int kAlikeWindow_px = 9;
constexpr double kAlikeFloor = 0.01;     // of the variance: below, noise is compared
constexpr double kSameSpotRatio = 0.03;  // of the width: a plane's fit is no closer than that

void require_grey(const SeenView& seen) {
  core::require(seen.grey.type() == CV_8UC1 && seen.grey.size() == seen.view.image_size_px,
                "the picture of a pair is 8-bit grey, of its view's size");
}

Vector2d pixel_of(const Features& features, int i) {
  return features.raw_px[static_cast<std::size_t>(i)].cast<double>();
}

geometry::PixelPairs pixels_of(const std::vector<Match>& matches, const Features& query,
                               const Features& match) {
  geometry::PixelPairs pairs;  // first: query
  for (const Match& pair : matches) {
    pairs.first_px.push_back(pixel_of(query, pair.second));
    pairs.second_px.push_back(pixel_of(match, pair.first));
  }
  return pairs;
}

bool is_inside(const Vector2d& pixel, const cv::Size& size_px) {
  return pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() <= size_px.width - 1.0 &&
         pixel.y() <= size_px.height - 1.0;
}

// What both see, of the query's picture, one point for each kGrid-th of its sides.
struct Overlap {
  double ratio = 0.0;
  Vector2d low = Vector2d::Zero();  // pixels
  Vector2d high = Vector2d::Zero();
};

Overlap overlap_of(const Matrix3d& match_from_query, const cv::Size& query_px,
                   const cv::Size& match_px) {
  constexpr int kGrid = 32;
  const Vector2d cell((query_px.width - 1.0) / kGrid, (query_px.height - 1.0) / kGrid);
  Overlap overlap{.low = {query_px.width, query_px.height}};
  int num_shared = 0;
  for (int row = 0; row < kGrid; ++row) {
    for (int column = 0; column < kGrid; ++column) {
      const Vector2d corner = cell.cwiseProduct(Vector2d(column, row));
      if (!is_inside(mapped(match_from_query, corner + 0.5 * cell), match_px)) continue;
      ++num_shared;
      overlap.low = overlap.low.cwiseMin(corner);
      overlap.high = overlap.high.cwiseMax(corner + cell);
    }
  }
  overlap.ratio = static_cast<double>(num_shared) / (kGrid * kGrid);
  return overlap;
}

// Pixels of the query from those of a plane: the square around the box of what both see.
Matrix3d query_from_plane(const Overlap& overlap) {
  const double side_px = (overlap.high - overlap.low).maxCoeff();
  const double scale = side_px / kPairSide_px;
  const Vector2d corner = 0.5 * (overlap.low + overlap.high) - Vector2d::Constant(0.5 * side_px);
  Matrix3d map = Matrix3d::Identity();
  map.diagonal() << scale, scale, 1.0;
  // the middle of a plane's first pixel is half of it away from the corner
  map.topRightCorner<2, 1>() = corner + Vector2d::Constant(0.5 * scale - 0.5);
  return map;
}

cv::Mat as_opencv(const Matrix3d& matrix) {
  cv::Mat copy(3, 3, CV_64F);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) copy.at<double>(row, column) = matrix(row, column);
  return copy;
}

// A plane of a picture, 32-bit float grey levels; blurred first, so that nothing is skipped where
// it shrinks.
cv::Mat brought(const cv::Mat& picture, const Matrix3d& picture_from_plane) {
  const Vector2d middle = Vector2d::Constant(0.5 * kPairSide_px);
  const Vector2d here = mapped(picture_from_plane, middle);
  const double step_px = (mapped(picture_from_plane, middle + Vector2d::UnitX()) - here).norm();
  cv::Mat smooth;
  if (std::isfinite(step_px) && step_px > 1.0) {
    cv::GaussianBlur(picture, smooth, {0, 0}, 0.5 * std::min(step_px, 16.0));
  } else {
    smooth = picture;
  }
  cv::Mat plane;
  cv::warpPerspective(smooth, plane, as_opencv(picture_from_plane), {kPairSide_px, kPairSide_px},
                      cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  plane.convertTo(plane, CV_32F);
  return plane;
}

// 1 where a plane's pixel lies in both pictures.
cv::Mat seen_by_both(const Matrix3d& query_from, const cv::Size& query_px,
                     const Matrix3d& match_from, const cv::Size& match_px) {
  cv::Mat mask(kPairSide_px, kPairSide_px, CV_32F);
  for (int row = 0; row < kPairSide_px; ++row) {
    for (int column = 0; column < kPairSide_px; ++column) {
      const Vector2d pixel(column, row);
      const bool is_seen = is_inside(mapped(query_from, pixel), query_px) &&
                           is_inside(mapped(match_from, pixel), match_px);
      mask.at<float>(row, column) = is_seen ? 1.0F : 0.0F;
    }
  }
  return mask;
}

cv::Mat mean_around(const cv::Mat& plane, const cv::Mat& mask, const cv::Mat& mask_around) {
  cv::Mat mean;
  cv::GaussianBlur(plane.mul(mask), mean, {0, 0}, kLightSigma_px);
  return mean / mask_around;
}

// Each pixel by the mean and the deviation of those around it that are seen by both (local contrast
// normalisation; Jarrett et al., ICCV 2009), scaled to [-1, 1].
cv::Mat without_light(const cv::Mat& plane, const cv::Mat& mask) {
  cv::Mat mask_around;
  cv::GaussianBlur(mask, mask_around, {0, 0}, kLightSigma_px);
  mask_around = cv::max(mask_around, 1e-3);
  const cv::Mat detail = plane - mean_around(plane, mask, mask_around);
  cv::Mat deviation;
  cv::sqrt(mean_around(detail.mul(detail), mask, mask_around), deviation);
  cv::Mat normal = detail / (kMaxContrast * (deviation + kContrastFloor));
  normal = cv::min(cv::max(normal, -1.0), 1.0);
  return normal.mul(mask);
}

cv::Mat mean_of_window(const cv::Mat& plane) {
  cv::Mat mean;
  cv::blur(plane, mean, {kAlikeWindow_px, kAlikeWindow_px}, {-1, -1}, cv::BORDER_CONSTANT);
  return mean;
}

cv::Mat shifted(const cv::Mat& plane, int x_px, int y_px) {
  const cv::Mat map = (cv::Mat_<double>(2, 3) << 1, 0, x_px, 0, 1, y_px);
  cv::Mat moved;
  cv::warpAffine(plane, moved, map, plane.size(), cv::INTER_NEAREST);
  return moved;
}

// Correlation of two pictures without their light, window by window: the best of all small shifts,
// since what is near lies elsewhere than the registration says.
cv::Mat alike(const cv::Mat& query, const cv::Mat& match, const cv::Mat& mask) {
  const cv::Mat of_query = mean_of_window(query.mul(query)) + kAlikeFloor;
  const cv::Mat of_match = mean_of_window(match.mul(match)) + kAlikeFloor;
  cv::Mat best = cv::Mat::zeros(query.size(), CV_32F);
  for (int y_px = -kAlikeShift_px; y_px <= kAlikeShift_px; ++y_px) {
    for (int x_px = -kAlikeShift_px; x_px <= kAlikeShift_px; ++x_px) {
      cv::Mat norm;
      cv::sqrt(of_query.mul(shifted(of_match, x_px, y_px)) + 1e-6, norm);
      best = cv::max(best, mean_of_window(query.mul(shifted(match, x_px, y_px))) / norm);
    }
  }
  return cv::min(best, 1.0).mul(mask);
}

// Soft dots of height 1 at these pixels of a plane.
cv::Mat dots(const std::vector<Vector2d>& pixels, const cv::Mat& mask) {
  cv::Mat plane = cv::Mat::zeros(kPairSide_px, kPairSide_px, CV_32F);
  for (const Vector2d& pixel : pixels) {
    const long column = std::lround(pixel.x());
    const long row = std::lround(pixel.y());
    if (column < 0 || row < 0 || column >= kPairSide_px || row >= kPairSide_px) continue;
    plane.at<float>(static_cast<int>(row), static_cast<int>(column)) = 1.0F;
  }
  cv::GaussianBlur(plane, plane, {0, 0}, kDotSigma_px);
  const double height = 1.0 / (2.0 * std::numbers::pi * kDotSigma_px * kDotSigma_px);
  return cv::min(plane / height, 1.0).mul(mask);
}

// One view, where its features lie in the other's picture, and the other.
struct Looker {
  const SeenView& own;
  const SeenView& other;
  Matrix3d other_from_own;
};

// Whether the other shows something like feature i about where it should be.
bool is_seen_again(const Looker& looker, int i, const Vector2d& where_px, int max_distance_bits) {
  const Features& others = *looker.other.view.features;
  const double radius_px = kSameSpotRatio * looker.other.view.image_size_px.width;
  const auto* const descriptor = looker.own.view.features->descriptors.ptr(i);
  for (int k = 0; k < others.size(); ++k) {
    if ((pixel_of(others, k) - where_px).squaredNorm() > radius_px * radius_px) continue;
    if (features::distance_bits(descriptor, others.descriptors.ptr(k)) <= max_distance_bits)
      return true;
  }
  return false;
}

// Pixels, in its own picture, of features that the other should show and does not.
std::vector<Vector2d> missed(const Looker& looker, int max_distance_bits) {
  const Features& own = *looker.own.view.features;
  std::vector<Vector2d> pixels;
  for (int i = 0; i < own.size(); ++i) {
    const Vector2d where_px = mapped(looker.other_from_own, pixel_of(own, i));
    if (!is_inside(where_px, looker.other.view.image_size_px)) continue;
    if (!is_seen_again(looker, i, where_px, max_distance_bits)) pixels.push_back(pixel_of(own, i));
  }
  return pixels;
}

std::vector<Vector2d> all_mapped(const Matrix3d& map, std::vector<Vector2d> pixels) {
  for (Vector2d& pixel : pixels) pixel = mapped(map, pixel);
  std::erase_if(pixels, [](const Vector2d& pixel) { return !pixel.allFinite(); });
  return pixels;
}

// Seeded by the pair: what was registered before does not matter.
core::Random random_of_registration(const features::View& query, const features::View& match) {
  const std::uint64_t query_seed = core::seed_of(0, "register", query.frame.value());
  return core::Random(core::seed_of(query_seed, "match", match.frame.value()));
}

cv::Mat stacked(const std::array<cv::Mat, kNumPairPlanes>& planes) {
  cv::Mat stack;
  cv::vconcat(planes.data(), planes.size(), stack);
  return stack;
}

}  // namespace

cv::Mat PairView::plane(PairPlane plane) const {
  const int first_row = static_cast<int>(plane) * kPairSide_px;
  return planes.rowRange(first_row, first_row + kPairSide_px);
}

std::vector<Match> agreeing_matches(const core::Candidate& candidate, const features::View& query,
                                    const features::View& match, const MeasureSettings& settings) {
  core::Random random = random_of(candidate, settings);
  const std::vector<Match> matches =
      match_pair(match.features->descriptors, query.features->descriptors, settings.features);
  const auto found = epipolar_inliers(query, match, matches, settings.verify, random);
  return found ? found->matches : std::vector<Match>();
}

std::optional<PairView> register_pair(const SeenView& query, const SeenView& match,
                                      const std::vector<Match>& matches,
                                      const features::Config& config) {
  require_grey(query);
  require_grey(match);
  const cv::Size query_px = query.view.image_size_px;
  const cv::Size match_px = match.view.image_size_px;
  const auto pairs = pixels_of(matches, *query.view.features, *match.view.features);
  core::Random random = random_of_registration(query.view, match.view);
  const auto registration = register_pictures(pairs, query_px, random);
  if (!registration) return std::nullopt;
  const Matrix3d& match_from_query = registration->second_from_first;
  const Overlap overlap = overlap_of(match_from_query, query_px, match_px);
  if (overlap.ratio < kMinOverlapRatio) return std::nullopt;

  const Matrix3d query_from = query_from_plane(overlap);
  const Matrix3d plane_from_query = query_from.inverse();
  const Matrix3d match_from = match_from_query * query_from;
  const Matrix3d query_from_match = match_from_query.inverse();
  const auto only_match = missed({match, query, query_from_match}, config.max_distance_bits);
  const auto only_query = missed({query, match, match_from_query}, config.max_distance_bits);
  const cv::Mat mask = seen_by_both(query_from, query_px, match_from, match_px);
  const cv::Mat query_plane = without_light(brought(query.grey, query_from), mask);
  const cv::Mat match_plane = without_light(brought(match.grey, match_from), mask);
  return PairView{
      .planes = stacked({query_plane, match_plane, mask,
                         dots(all_mapped(plane_from_query, pairs.first_px), mask),
                         dots(all_mapped(plane_from_query, only_query), mask),
                         dots(all_mapped(plane_from_query * query_from_match, only_match), mask),
                         alike(query_plane, match_plane, mask)}),
      .overlap_ratio = overlap.ratio,
      .scale = query_from(0, 0),
      .is_homography = registration->is_homography};
}

}  // namespace samewhere::verify
