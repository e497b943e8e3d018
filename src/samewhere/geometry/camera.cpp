#include <cmath>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/camera.hpp>

namespace samewhere::geometry {
namespace {

using core::PinholeRadtan;

bool is_distorted(const PinholeRadtan& c) {
  return c.k1 != 0.0 || c.k2 != 0.0 || c.p1 != 0.0 || c.p2 != 0.0 || c.k3 != 0.0;
}

// On the plane z = 1 (Brown 1966): radial k1 k2 k3, tangential p1 p2.
Eigen::Vector2d distort(const PinholeRadtan& c, const Eigen::Vector2d& ideal) {
  const double x = ideal.x();
  const double y = ideal.y();
  const double r2 = ideal.squaredNorm();
  const double radial = 1.0 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  return {x * radial + 2.0 * c.p1 * x * y + c.p2 * (r2 + 2.0 * x * x),
          y * radial + c.p1 * (r2 + 2.0 * y * y) + 2.0 * c.p2 * x * y};
}

// Whether radial distortion has turned back on the way out to here: what lies so far outside would
// appear in the picture again. It goes outwards as long as the derivative of r * radial, a
// polynomial in r2, is positive from the middle on.
bool is_folded(const PinholeRadtan& c, double r2) {
  const auto slope = [&](double s) {
    return 1.0 + s * (3.0 * c.k1 + s * (5.0 * c.k2 + s * 7.0 * c.k3));
  };
  const auto turns_at = [&](double s) { return s > 0.0 && s < r2 && slope(s) <= 0.0; };
  if (slope(r2) <= 0.0) return true;
  // least on the way where 3 k1 + 10 k2 s + 21 k3 s^2 is 0
  if (c.k3 == 0.0) return c.k2 != 0.0 && turns_at(-0.3 * c.k1 / c.k2);
  const double discriminant = 25.0 * c.k2 * c.k2 - 63.0 * c.k1 * c.k3;
  if (discriminant < 0.0) return false;
  const double root = std::sqrt(discriminant);
  return turns_at((-5.0 * c.k2 - root) / (21.0 * c.k3)) ||
         turns_at((-5.0 * c.k2 + root) / (21.0 * c.k3));
}

Eigen::Matrix2d distort_jacobian(const PinholeRadtan& c, const Eigen::Vector2d& ideal) {
  const double x = ideal.x();
  const double y = ideal.y();
  const double r2 = ideal.squaredNorm();
  const double radial = 1.0 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  const double slope =
      2.0 * (c.k1 + r2 * (2.0 * c.k2 + r2 * 3.0 * c.k3));  // d radial / d r2, doubled
  Eigen::Matrix2d j;
  j(0, 0) = radial + slope * x * x + 2.0 * c.p1 * y + 6.0 * c.p2 * x;
  j(0, 1) = slope * x * y + 2.0 * c.p1 * x + 2.0 * c.p2 * y;
  j(1, 0) = j(0, 1);
  j(1, 1) = radial + slope * y * y + 6.0 * c.p1 * y + 2.0 * c.p2 * x;
  return j;
}

// Newton's method. Strong distortion folds the plane far outside the picture, where there is no
// inverse: stop there at the last good point rather than run away.
Eigen::Vector2d undistort_plane(const PinholeRadtan& c, const Eigen::Vector2d& distorted) {
  constexpr int kMaxIterations = 20;
  constexpr double kConverged = 1e-12;
  Eigen::Vector2d ideal = distorted;
  for (int i = 0; i < kMaxIterations; ++i) {
    const Eigen::Vector2d error = distort(c, ideal) - distorted;
    if (error.squaredNorm() < kConverged * kConverged) break;
    const Eigen::Matrix2d j = distort_jacobian(c, ideal);
    if (j.determinant() < 1e-3) break;
    ideal -= j.inverse() * error;
  }
  return ideal;
}

Eigen::Vector2d to_plane(const PinholeRadtan& c, const Eigen::Vector2d& pixel) {
  return {(pixel.x() - c.cx_px) / c.fx_px, (pixel.y() - c.cy_px) / c.fy_px};
}

Eigen::Vector2d to_pixel(const PinholeRadtan& c, const Eigen::Vector2d& plane) {
  return {c.fx_px * plane.x() + c.cx_px, c.fy_px * plane.y() + c.cy_px};  // eq. (17)
}

constexpr double kMinDepth_m = 1e-6;

}  // namespace

std::optional<Eigen::Vector2d> project(const core::Camera& camera,
                                       const Eigen::Vector3d& point_in_camera) {
  if (point_in_camera.z() < kMinDepth_m) return std::nullopt;
  const PinholeRadtan& c = pinhole(camera);
  const Eigen::Vector2d ideal = point_in_camera.hnormalized();
  if (is_folded(c, ideal.squaredNorm())) return std::nullopt;
  return to_pixel(c, distort(c, ideal));
}

std::optional<Eigen::Vector2d> project_undistorted(const core::Camera& camera,
                                                   const Eigen::Vector3d& point_in_camera) {
  if (point_in_camera.z() < kMinDepth_m) return std::nullopt;
  return to_pixel(pinhole(camera), point_in_camera.hnormalized());
}

Eigen::Vector2d undistort(const core::Camera& camera, const Eigen::Vector2d& pixel) {
  const PinholeRadtan& c = pinhole(camera);
  if (!is_distorted(c)) return pixel;
  return to_pixel(c, undistort_plane(c, to_plane(c, pixel)));
}

Eigen::Vector3d bearing(const core::Camera& camera, const Eigen::Vector2d& pixel) {
  return bearing_of_undistorted(camera, undistort(camera, pixel));
}

Eigen::Vector3d bearing_of_undistorted(const core::Camera& camera,
                                       const Eigen::Vector2d& undistorted) {
  return to_plane(pinhole(camera), undistorted).homogeneous().normalized();
}

const core::PinholeRadtan& pinhole(const core::Camera& camera) {
  return std::get<PinholeRadtan>(camera);
}

Eigen::Matrix3d calibration_matrix(const core::Camera& camera) {
  const PinholeRadtan& c = pinhole(camera);
  Eigen::Matrix3d k;
  k << c.fx_px, 0.0, c.cx_px, 0.0, c.fy_px, c.cy_px, 0.0, 0.0, 1.0;
  return k;
}

double focal_px(const core::Camera& camera) {
  const PinholeRadtan& c = pinhole(camera);
  return 0.5 * (c.fx_px + c.fy_px);
}

double horizontal_field_of_view_rad(const core::Camera& camera) {
  const PinholeRadtan& c = pinhole(camera);
  core::require(c.width_px > 0, "a camera with a field of view knows the width of its pictures");
  // half a pixel more on both sides: pixels are as wide as they are apart
  const double left_rad = std::atan((c.cx_px + 0.5) / c.fx_px);
  const double right_rad = std::atan((c.width_px - 0.5 - c.cx_px) / c.fx_px);
  return left_rad + right_rad;
}

}  // namespace samewhere::geometry
