#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <samewhere/features/corners.hpp>
#include <samewhere/features/describe.hpp>
#include <samewhere/features/orb.hpp>
#include <samewhere/features/preprocess.hpp>
#include <samewhere/features/pyramid.hpp>
#include <samewhere/features/stereo.hpp>
#include <samewhere/geometry/camera.hpp>

namespace samewhere::features {
namespace {

// The second picture of a pair gives more features, so that the corners chosen in the first are
// among them.
constexpr int kRightPerLeft = 3;

// 0 where the sensor saw nothing.
float depth_at(const cv::Mat& depth_m, const Eigen::Vector2f& pixel) {
  const int x = std::clamp(static_cast<int>(std::lround(pixel.x())), 0, depth_m.cols - 1);
  const int y = std::clamp(static_cast<int>(std::lround(pixel.y())), 0, depth_m.rows - 1);
  return depth_m.at<float>(y, x);
}

std::array<std::uint8_t, 3> colour_at(const cv::Mat& image, const Eigen::Vector2f& pixel) {
  const int x = std::clamp(static_cast<int>(std::lround(pixel.x())), 0, image.cols - 1);
  const int y = std::clamp(static_cast<int>(std::lround(pixel.y())), 0, image.rows - 1);
  if (image.channels() == 1) {
    const std::uint8_t grey = image.at<std::uint8_t>(y, x);
    return {grey, grey, grey};
  }
  const auto& bgr = image.at<cv::Vec3b>(y, x);
  return {bgr[2], bgr[1], bgr[0]};
}

// What can be said of the corners of a pyramid without its camera.
Features features_of(const std::vector<cv::Mat>& levels, const Config& config) {
  std::vector<Corner> corners;
  std::vector<cv::Mat> blurred;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const auto found = find_corners(levels[i], static_cast<int>(i), config);
    corners.insert(corners.end(), found.begin(), found.end());
    blurred.push_back(blurred_for_descriptors(levels[i]));
  }
  corners = spread_evenly(std::move(corners), config);
  Features features;
  features.descriptors = cv::Mat(static_cast<int>(corners.size()), kDescriptorBytes, CV_8U);
  for (const Corner& whole : corners) {
    const auto level = static_cast<std::size_t>(whole.level);
    const Corner corner = with_subpixel(levels[level], whole);
    const float angle_rad = orientation_rad(levels[level], corner.level_px);
    describe(blurred[level], corner.level_px, angle_rad, features.descriptors.ptr(features.size()));
    features.raw_px.push_back(full_from_level(corner.level_px, levels[level], levels[0]));
    features.octave.push_back(corner.level);
    features.angle_rad.push_back(angle_rad);
  }
  return features;
}

// Where an ideal camera would see them, and in which colour they are.
void add_camera(Features& features, const core::Frame& frame) {
  for (const Eigen::Vector2f& raw_px : features.raw_px) {
    features.undistorted_px.push_back(
        frame.rig->is_calibrated()
            ? Eigen::Vector2f(
                  geometry::undistort(frame.rig->cameras[0], raw_px.cast<double>()).cast<float>())
            : raw_px);
    features.rgb.push_back(colour_at(frame.images[0], raw_px));
  }
}

// Focal length times baseline: disparity times depth.
double disparity_px_m(const core::Rig& rig, const Config& config) {
  return geometry::pinhole(rig.cameras[0]).fx_px * baseline_m(rig, config);
}

void add_measured_depth(Features& features, const core::Frame& frame, const Config& config) {
  for (std::size_t i = 0; i < features.raw_px.size(); ++i) {
    const float depth_m = depth_at(*frame.depth_m, features.raw_px[i]);
    features.depth_m[i] = depth_m;
    if (depth_m <= 0.0F || !frame.rig->is_calibrated()) continue;
    const double disparity_px = disparity_px_m(*frame.rig, config) / depth_m;
    features.right_x_px[i] = static_cast<float>(features.undistorted_px[i].x() - disparity_px);
  }
}

void add_stereo_depth(Features& features, const std::vector<cv::Mat>& levels,
                      const core::Frame& frame, const Config& config) {
  const std::vector<cv::Mat> right_levels = pyramid(preprocess(frame.images[1], config), config);
  Config generous = config;
  generous.num_features *= kRightPerLeft;
  const Features right = features_of(right_levels, generous);
  features.right_x_px = match_stereo({levels, features}, {right_levels, right}, *frame.rig, config);
  const double depth_times_disparity = disparity_px_m(*frame.rig, config);
  for (std::size_t i = 0; i < features.raw_px.size(); ++i) {
    const float disparity_px = features.raw_px[i].x() - features.right_x_px[i];
    if (std::isnan(disparity_px)) continue;
    features.depth_m[i] = static_cast<float>(depth_times_disparity / disparity_px);
  }
}

}  // namespace

View extract(const core::Frame& frame, const Config& config) {
  const cv::Mat grey = preprocess(frame.images.at(0), config);
  const std::vector<cv::Mat> levels = pyramid(grey, config);
  auto features = std::make_shared<Features>(features_of(levels, config));
  add_camera(*features, frame);
  features->depth_m.assign(features->raw_px.size(), 0.0F);
  features->right_x_px.assign(features->raw_px.size(), std::numeric_limits<float>::quiet_NaN());
  if (frame.depth_m) {
    add_measured_depth(*features, frame, config);
  } else if (is_stereo(frame)) {
    add_stereo_depth(*features, levels, frame, config);
  }
  return {frame.id, frame.stamp_s, frame.rig, grey.size(), std::move(features)};
}

}  // namespace samewhere::features
