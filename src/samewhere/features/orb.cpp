#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include <samewhere/features/orb.hpp>
#include <samewhere/geometry/camera.hpp>

namespace samewhere::features {
namespace {

constexpr int kMinSide_px = 64;  // smaller pictures have no room for a patch on the upper levels
constexpr int kBorder_px = 19;   // half a patch and its blur
constexpr int kPatch_px = 31;    // of ORB
// More than most pictures have: the strongest corners must not crowd out a quiet part before they
// are spread.
constexpr int kMaxDetected = 10000;

// Levels that still have room for a patch and its border.
int num_usable_levels(const cv::Size& size_px, const Config& config) {
  const double room = std::min(size_px.width, size_px.height) / static_cast<double>(kMinSide_px);
  const double levels = std::floor(std::log(room) / std::log(config.scale_factor)) + 1.0;
  return static_cast<int>(std::clamp(levels, 1.0, static_cast<double>(config.num_levels)));
}

bool is_stronger(const cv::KeyPoint& a, const cv::KeyPoint& b) {
  if (a.response != b.response) return a.response > b.response;
  return std::tuple(a.octave, a.pt.y, a.pt.x) < std::tuple(b.octave, b.pt.y, b.pt.x);
}

// 0 where the sensor saw nothing.
float depth_at(const cv::Mat& depth_m, const cv::Point2f& pixel) {
  const int x = std::clamp(static_cast<int>(std::lround(pixel.x)), 0, depth_m.cols - 1);
  const int y = std::clamp(static_cast<int>(std::lround(pixel.y)), 0, depth_m.rows - 1);
  return depth_m.at<float>(y, x);
}

std::array<std::uint8_t, 3> colour_at(const cv::Mat& image, const cv::Point2f& pixel) {
  const int x = std::clamp(static_cast<int>(std::lround(pixel.x)), 0, image.cols - 1);
  const int y = std::clamp(static_cast<int>(std::lround(pixel.y)), 0, image.rows - 1);
  if (image.channels() == 1) {
    const std::uint8_t grey = image.at<std::uint8_t>(y, x);
    return {grey, grey, grey};
  }
  const auto& bgr = image.at<cv::Vec3b>(y, x);
  return {bgr[2], bgr[1], bgr[0]};
}

void append(Features& features, const cv::KeyPoint& keypoint, const core::Frame& frame,
            const Config& config) {
  const Eigen::Vector2d raw(keypoint.pt.x, keypoint.pt.y);
  const bool is_calibrated = frame.rig->is_calibrated();
  const Eigen::Vector2d undistorted =
      is_calibrated ? geometry::undistort(frame.rig->cameras[0], raw) : raw;
  const float depth_m = frame.depth_m ? depth_at(*frame.depth_m, keypoint.pt) : 0.0F;
  double right_x_px = std::numeric_limits<double>::quiet_NaN();
  if (depth_m > 0.0F && is_calibrated) {
    const double disparity_px =
        config.virtual_baseline_m * geometry::pinhole(frame.rig->cameras[0]).fx_px / depth_m;
    right_x_px = undistorted.x() - disparity_px;
  }
  features.raw_px.push_back(raw.cast<float>());
  features.undistorted_px.push_back(undistorted.cast<float>());
  features.depth_m.push_back(depth_m);
  features.right_x_px.push_back(static_cast<float>(right_x_px));
  features.rgb.push_back(colour_at(frame.images[0], keypoint.pt));
  features.octave.push_back(keypoint.octave);
  features.angle_rad.push_back(keypoint.angle * std::numbers::pi_v<float> / 180.0F);
}

}  // namespace

cv::Mat as_grey(const cv::Mat& image) {
  if (image.channels() == 1) return image;
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

std::vector<cv::KeyPoint> spread_evenly(std::vector<cv::KeyPoint> keypoints, int count,
                                        int cell_px) {
  std::sort(keypoints.begin(), keypoints.end(), is_stronger);
  std::map<std::pair<int, int>, int> taken_of_cell;
  std::vector<std::pair<int, std::size_t>> rank_and_index;
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    const std::pair cell(static_cast<int>(keypoints[i].pt.x) / cell_px,
                         static_cast<int>(keypoints[i].pt.y) / cell_px);
    rank_and_index.emplace_back(taken_of_cell[cell]++, i);
  }
  std::sort(rank_and_index.begin(), rank_and_index.end());
  const auto kept = std::min(rank_and_index.size(), static_cast<std::size_t>(count));
  std::vector<cv::KeyPoint> spread;
  spread.reserve(kept);
  for (std::size_t i = 0; i < kept; ++i) spread.push_back(keypoints[rank_and_index[i].second]);
  return spread;
}

View extract(const core::Frame& frame, const Config& config) {
  const cv::Mat grey = as_grey(frame.images.at(0));
  auto features = std::make_shared<Features>();
  if (std::min(grey.rows, grey.cols) >= kMinSide_px) {
    const int num_levels = num_usable_levels(grey.size(), config);
    const auto orb = cv::ORB::create(
        std::max(kMaxDetected, config.num_features), static_cast<float>(config.scale_factor),
        num_levels, kBorder_px, 0, 2, cv::ORB::HARRIS_SCORE, kPatch_px, config.min_corner_contrast);
    std::vector<cv::KeyPoint> keypoints;
    orb->detect(grey, keypoints);
    keypoints = spread_evenly(std::move(keypoints), config.num_features, config.cell_px);
    orb->compute(grey, keypoints, features->descriptors);
    for (const auto& keypoint : keypoints) append(*features, keypoint, frame, config);
  }
  if (features->descriptors.empty()) features->descriptors = cv::Mat(0, 32, CV_8U);
  return {frame.id, frame.stamp_s, frame.rig, grey.size(), std::move(features)};
}

}  // namespace samewhere::features
