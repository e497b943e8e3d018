#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/input/straighten.hpp>

namespace samewhere::input {
namespace {

using core::PinholeRadtan;

PinholeRadtan centred_pinhole(const Eigen::Vector2i& size_px, double focal_px) {
  return {.width_px = size_px.x(),
          .height_px = size_px.y(),
          .fx_px = focal_px,
          .fy_px = focal_px,
          .cx_px = 0.5 * (size_px.x() - 1.0),
          .cy_px = 0.5 * (size_px.y() - 1.0)};
}

// Where the picture of `camera` shows what the pinhole shows at a pixel, if it does.
std::optional<Eigen::Vector2d> taken_pixel(const core::Camera& camera, const PinholeRadtan& pinhole,
                                           const Eigen::Vector2d& pixel) {
  const auto taken = geometry::project(camera, geometry::bearing(pinhole, pixel));
  if (!taken) return std::nullopt;
  const Eigen::Vector2i size_px = geometry::picture_size_px(camera);
  const bool is_inside = taken->x() >= 0.0 && taken->x() <= size_px.x() - 1.0 &&
                         taken->y() >= 0.0 && taken->y() <= size_px.y() - 1.0;
  return is_inside ? taken : std::nullopt;
}

bool shows_border_of(const core::Camera& camera, const PinholeRadtan& pinhole) {
  constexpr int kSteps = 32;
  const Eigen::Vector2d last_px(pinhole.width_px - 1.0, pinhole.height_px - 1.0);
  for (int i = 0; i <= kSteps; ++i) {
    const Eigen::Vector2d along_px = last_px * i / kSteps;
    for (const Eigen::Vector2d& pixel :
         {Eigen::Vector2d(along_px.x(), 0.0), Eigen::Vector2d(along_px.x(), last_px.y()),
          Eigen::Vector2d(0.0, along_px.y()), Eigen::Vector2d(last_px.x(), along_px.y())}) {
      if (!taken_pixel(camera, pinhole, pixel)) return false;
    }
  }
  return true;
}

}  // namespace

cv::Mat PixelMap::apply(const cv::Mat& taken, int interpolation) const {
  cv::Mat turned;
  cv::remap(taken, turned, x_px, y_px, interpolation, cv::BORDER_CONSTANT);
  return turned;
}

PinholeRadtan ideal_pinhole(const core::Camera& camera) {
  const Eigen::Vector2i size_px = geometry::picture_size_px(camera);
  core::require(size_px.minCoeff() > 0, "a camera whose pictures are straightened has a size");
  constexpr double kNarrower = 1.02;
  constexpr int kMaxSteps = 200;  // 52 times as narrow
  double focal_px =
      0.5 * size_px.maxCoeff() / std::tan(0.5 * kWidestPinhole_deg * std::numbers::pi / 180.0);
  for (int i = 0; i < kMaxSteps; ++i, focal_px *= kNarrower) {
    const PinholeRadtan pinhole = centred_pinhole(size_px, focal_px);
    if (shows_border_of(camera, pinhole)) return pinhole;
  }
  throw core::InputError(
      "calibration: the camera's picture holds that of no pinhole; expected a centre well inside "
      "and distortion that can be undone");
}

PixelMap pixel_map(const core::Camera& camera, const PinholeRadtan& turned,
                   const cv::Matx33d& turned_from_taken) {
  constexpr float kNowhere = -1e4F;
  // row by row is the transpose column by column
  const Eigen::Matrix3d taken_from_turned =
      Eigen::Map<const Eigen::Matrix3d>(turned_from_taken.val);
  PixelMap map{cv::Mat(turned.height_px, turned.width_px, CV_32FC1, kNowhere),
               cv::Mat(turned.height_px, turned.width_px, CV_32FC1, kNowhere)};
  for (int y = 0; y < turned.height_px; ++y) {
    for (int x = 0; x < turned.width_px; ++x) {
      const Eigen::Vector3d direction = geometry::bearing(turned, Eigen::Vector2d(x, y));
      const auto taken = geometry::project(camera, taken_from_turned * direction);
      if (!taken || taken->norm() > std::numeric_limits<short>::max()) continue;
      map.x_px.at<float>(y, x) = static_cast<float>(taken->x());
      map.y_px.at<float>(y, x) = static_cast<float>(taken->y());
    }
  }
  return map;
}

}  // namespace samewhere::input
