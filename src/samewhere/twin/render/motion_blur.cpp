#include <algorithm>
#include <cmath>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/twin/render/motion_blur.hpp>

namespace samewhere::twin {
namespace {

constexpr float kSharp_px = 0.5F;
constexpr float kLongest_px = 15.0F;

// Where points of the picture move while the shutter is open.
class MotionField {
 public:
  MotionField(const core::PinholeRadtan& camera, const CameraMotion& motion, double exposure_s)
      : focal_px_(static_cast<float>(camera.fx_px), static_cast<float>(camera.fy_px)),
        centre_px_(static_cast<float>(camera.cx_px), static_cast<float>(camera.cy_px)),
        shift_m_((exposure_s * motion.velocity_m_s).cast<float>()),
        turn_rad_((exposure_s * motion.angular_velocity_rad_s).cast<float>()) {}

  // From the opening of the shutter to its closing, pixels.
  Eigen::Vector2f at(int x_px, int y_px, float depth_m) const {
    const Eigen::Vector2f pixel(static_cast<float>(x_px), static_cast<float>(y_px));
    const Eigen::Vector3f point = (pixel - centre_px_).cwiseQuotient(focal_px_).homogeneous();
    const float per_m = depth_m > 0.0F ? 1.0F / depth_m : 0.0F;
    const Eigen::Vector3f moves = -per_m * shift_m_ - turn_rad_.cross(point);
    const Eigen::Vector2f shift_px =
        focal_px_.cwiseProduct(moves.head<2>() - moves.z() * point.head<2>());
    return shift_px * std::min(1.0F, kLongest_px / std::max(shift_px.norm(), 1e-6F));
  }

 private:
  Eigen::Vector2f focal_px_;
  Eigen::Vector2f centre_px_;
  Eigen::Vector3f shift_m_;
  Eigen::Vector3f turn_rad_;
};

cv::Vec3f between_pixels(const cv::Mat& picture, const Eigen::Vector2f& pixel) {
  const float x = std::clamp(pixel.x(), 0.0F, static_cast<float>(picture.cols - 1));
  const float y = std::clamp(pixel.y(), 0.0F, static_cast<float>(picture.rows - 1));
  const int column = std::min(static_cast<int>(x), picture.cols - 2);
  const int row = std::min(static_cast<int>(y), picture.rows - 2);
  const float right = x - static_cast<float>(column);
  const float down = y - static_cast<float>(row);
  const auto* const upper = picture.ptr<cv::Vec3f>(row) + column;
  const auto* const lower = picture.ptr<cv::Vec3f>(row + 1) + column;
  return (1.0F - down) * ((1.0F - right) * upper[0] + right * upper[1]) +
         down * ((1.0F - right) * lower[0] + right * lower[1]);
}

cv::Vec3f mean_along(const cv::Mat& radiance, const Eigen::Vector2f& middle,
                     const Eigen::Vector2f& shift_px) {
  constexpr float kSpacing_px = 2.0F;
  const int num_taps = 2 + static_cast<int>(shift_px.norm() / kSpacing_px);
  const Eigen::Vector2f step = shift_px / static_cast<float>(num_taps);
  Eigen::Vector2f at = middle - 0.5F * (shift_px - step);
  cv::Vec3f sum(0.0F, 0.0F, 0.0F);
  for (int i = 0; i < num_taps; ++i, at += step) sum += between_pixels(radiance, at);
  return sum / static_cast<float>(num_taps);
}

}  // namespace

CameraMotion motion_between(const core::Rigid3& world_from_first,
                            const core::Rigid3& world_from_second, double duration_s) {
  const core::Rigid3 first_from_second = inverse(world_from_first) * world_from_second;
  return {.velocity_m_s = first_from_second.translation / duration_s,
          .angular_velocity_rad_s = core::log_so3(first_from_second.rotation) / duration_s};
}

cv::Mat blur_by_motion(const View& view, const core::Camera& camera, const CameraMotion& motion,
                       double exposure_s) {
  const MotionField field(geometry::pinhole(camera), motion, exposure_s);
  cv::Mat blurred(view.radiance.size(), CV_32FC3);
  for (int y = 0; y < blurred.rows; ++y) {
    const auto* const sharp = view.radiance.ptr<cv::Vec3f>(y);
    const auto* const depth_m = view.depth_m.ptr<float>(y);
    auto* const to = blurred.ptr<cv::Vec3f>(y);
    for (int x = 0; x < blurred.cols; ++x) {
      const Eigen::Vector2f shift_px = field.at(x, y, depth_m[x]);
      const bool is_sharp = shift_px.squaredNorm() < kSharp_px * kSharp_px;
      to[x] = is_sharp ? sharp[x]
                       : mean_along(view.radiance, {static_cast<float>(x), static_cast<float>(y)},
                                    shift_px);
    }
  }
  return blurred;
}

}  // namespace samewhere::twin
