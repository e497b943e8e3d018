#include <algorithm>
#include <cmath>
#include <numbers>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/camera.hpp>

namespace samewhere::geometry {
namespace {

using core::PinholeRadtan;

using core::KannalaBrandt;

bool is_rational(const PinholeRadtan& c) { return c.k4 != 0.0 || c.k5 != 0.0 || c.k6 != 0.0; }

bool is_distorted(const PinholeRadtan& c) {
  return c.k1 != 0.0 || c.k2 != 0.0 || c.p1 != 0.0 || c.p2 != 0.0 || c.k3 != 0.0 || is_rational(c);
}

// The factor by which radial distortion moves a point of the plane z = 1 at the squared radius r2,
// and twice its derivative by r2.
struct Radial {
  double factor = 1.0;
  double slope = 0.0;
};

Radial radial_at(const PinholeRadtan& c, double r2) {
  const Radial above{1.0 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3)),
                     2.0 * (c.k1 + r2 * (2.0 * c.k2 + r2 * 3.0 * c.k3))};
  if (!is_rational(c)) return above;
  const double below = 1.0 + r2 * (c.k4 + r2 * (c.k5 + r2 * c.k6));
  const double below_slope = 2.0 * (c.k4 + r2 * (2.0 * c.k5 + r2 * 3.0 * c.k6));
  return {above.factor / below,
          (above.slope * below - above.factor * below_slope) / (below * below)};
}

// On the plane z = 1 (Brown 1966): radial k1 k2 k3, tangential p1 p2.
Eigen::Vector2d distort(const PinholeRadtan& c, const Eigen::Vector2d& ideal) {
  const double x = ideal.x();
  const double y = ideal.y();
  const double r2 = ideal.squaredNorm();
  const double radial = radial_at(c, r2).factor;
  return {x * radial + 2.0 * c.p1 * x * y + c.p2 * (r2 + 2.0 * x * x),
          y * radial + c.p1 * (r2 + 2.0 * y * y) + 2.0 * c.p2 * x * y};
}

// The same of the rational model: a quotient, looked at in steps on the way.
bool is_quotient_folded(const PinholeRadtan& c, double r2) {
  constexpr int kSteps = 64;
  for (int i = 1; i <= kSteps; ++i) {
    const double s = r2 * i / kSteps;
    const auto [factor, slope] = radial_at(c, s);
    const bool goes_outwards = factor > 0.0 && factor + s * slope > 0.0;
    if (!goes_outwards) return true;
  }
  return false;
}

// Whether radial distortion has turned back on the way out to here: what lies so far outside would
// appear in the picture again. It goes outwards as long as the derivative of r * radial, a
// polynomial in r2, is positive from the middle on.
bool is_folded(const PinholeRadtan& c, double r2) {
  if (is_rational(c)) return is_quotient_folded(c, r2);
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
  const auto [radial, slope] = radial_at(c, r2);
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
    if (!(j.determinant() >= 1e-3)) break;
    ideal -= j.inverse() * error;
  }
  return ideal;
}

template <class Model>
Eigen::Vector2d to_plane(const Model& c, const Eigen::Vector2d& pixel) {
  return {(pixel.x() - c.cx_px) / c.fx_px, (pixel.y() - c.cy_px) / c.fy_px};
}

template <class Model>
Eigen::Vector2d to_pixel(const Model& c, const Eigen::Vector2d& plane) {
  return {c.fx_px * plane.x() + c.cx_px, c.fy_px * plane.y() + c.cy_px};  // eq. (17)
}

constexpr double kMinDepth_m = 1e-6;

std::optional<Eigen::Vector2d> project_by(const PinholeRadtan& c, const Eigen::Vector3d& point) {
  if (!(point.z() >= kMinDepth_m)) return std::nullopt;
  const Eigen::Vector2d ideal = point.hnormalized();
  if (is_folded(c, ideal.squaredNorm())) return std::nullopt;
  return to_pixel(c, distort(c, ideal));
}

Eigen::Vector2d undistort_by(const PinholeRadtan& c, const Eigen::Vector2d& pixel) {
  if (!is_distorted(c)) return pixel;
  return to_pixel(c, undistort_plane(c, to_plane(c, pixel)));
}

Eigen::Vector3d bearing_by(const PinholeRadtan& c, const Eigen::Vector2d& pixel) {
  return to_plane(c, undistort_by(c, pixel)).homogeneous().normalized();
}

double bent_angle(const KannalaBrandt& c, double angle) {
  const double s = angle * angle;
  return angle * (1.0 + s * (c.k1 + s * (c.k2 + s * (c.k3 + s * c.k4))));
}

double bent_angle_slope(const KannalaBrandt& c, double angle) {
  const double s = angle * angle;
  return 1.0 + s * (3.0 * c.k1 + s * (5.0 * c.k2 + s * (7.0 * c.k3 + s * 9.0 * c.k4)));
}

// Whether an angle is beyond where the picture turns back.
bool is_folded(const KannalaBrandt& c, double angle) {
  constexpr int kSteps = 32;
  for (int i = 1; i <= kSteps; ++i) {
    if (!(bent_angle_slope(c, angle * i / kSteps) > 0.0)) return true;
  }
  return false;
}

std::optional<Eigen::Vector2d> project_by(const KannalaBrandt& c, const Eigen::Vector3d& point) {
  const double aside = point.head<2>().norm();
  const double angle = std::atan2(aside, point.z());
  if (aside == 0.0 && point.z() < kMinDepth_m) return std::nullopt;
  if (is_folded(c, angle)) return std::nullopt;
  const double stretch = aside > 0.0 ? bent_angle(c, angle) / aside : 0.0;
  return to_pixel(c, stretch * point.head<2>());
}

// Newton's method within [0, pi]; the angle at which the picture ends where there is no inverse.
double straight_angle(const KannalaBrandt& c, double bent) {
  constexpr int kMaxIterations = 30;
  constexpr double kConverged = 1e-13;
  double angle = std::min(bent, std::numbers::pi);
  for (int i = 0; i < kMaxIterations; ++i) {
    const double slope = bent_angle_slope(c, angle);
    if (!(slope > 1e-3)) {  // too far out
      angle *= 0.7;
      continue;
    }
    const double step = (bent_angle(c, angle) - bent) / slope;
    angle = std::clamp(angle - step, 0.0, std::numbers::pi);
    if (std::abs(step) < kConverged) break;
  }
  return angle;
}

Eigen::Vector3d bearing_by(const KannalaBrandt& c, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d bent = to_plane(c, pixel);
  const double bent_norm = bent.norm();
  if (bent_norm == 0.0) return Eigen::Vector3d::UnitZ();
  const double angle = straight_angle(c, bent_norm);
  const Eigen::Vector2d aside = bent * (std::sin(angle) / bent_norm);
  return {aside.x(), aside.y(), std::cos(angle)};
}

Eigen::Vector2d undistort_by(const KannalaBrandt& c, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d bent = to_plane(c, pixel);
  const double bent_norm = bent.norm();
  if (bent_norm == 0.0) return pixel;
  const double angle = std::min(straight_angle(c, bent_norm), kMaxPinholeAngle_rad);
  return to_pixel(c, bent * (std::tan(angle) / bent_norm));
}

// A pixel becomes an index: what is no number, or too large for one, is no pixel.
std::optional<Eigen::Vector2d> finite(const std::optional<Eigen::Vector2d>& pixel) {
  constexpr double kFarthest_px = 1e9;
  const auto is_index = [](double at_px) { return std::abs(at_px) < kFarthest_px; };
  return pixel && is_index(pixel->x()) && is_index(pixel->y()) ? pixel : std::nullopt;
}

}  // namespace

std::optional<Eigen::Vector2d> project(const core::Camera& camera,
                                       const Eigen::Vector3d& point_in_camera) {
  return finite(std::visit([&](const auto& c) { return project_by(c, point_in_camera); }, camera));
}

std::optional<Eigen::Vector2d> project_undistorted(const core::Camera& camera,
                                                   const Eigen::Vector3d& point_in_camera) {
  if (!(point_in_camera.z() >= kMinDepth_m)) return std::nullopt;
  const Eigen::Vector2d ideal = point_in_camera.hnormalized();
  return finite(std::visit([&](const auto& c) { return to_pixel(c, ideal); }, camera));
}

Eigen::Vector2d undistort(const core::Camera& camera, const Eigen::Vector2d& pixel) {
  return std::visit([&](const auto& c) { return undistort_by(c, pixel); }, camera);
}

Eigen::Vector3d bearing(const core::Camera& camera, const Eigen::Vector2d& pixel) {
  return std::visit([&](const auto& c) { return bearing_by(c, pixel); }, camera);
}

Eigen::Vector3d bearing_of_undistorted(const core::Camera& camera,
                                       const Eigen::Vector2d& undistorted) {
  const Eigen::Vector2d ideal =
      std::visit([&](const auto& c) { return to_plane(c, undistorted); }, camera);
  return ideal.homogeneous().normalized();
}

const core::PinholeRadtan& pinhole(const core::Camera& camera) {
  const auto* model = std::get_if<PinholeRadtan>(&camera);
  core::require(model != nullptr, "pictures of a fisheye are turned into those of a pinhole first");
  return *model;
}

Eigen::Vector2i picture_size_px(const core::Camera& camera) {
  return std::visit([](const auto& c) { return Eigen::Vector2i(c.width_px, c.height_px); }, camera);
}

Eigen::Vector2d focal_lengths_px(const core::Camera& camera) {
  return std::visit([](const auto& c) { return Eigen::Vector2d(c.fx_px, c.fy_px); }, camera);
}

Eigen::Vector2d centre_px(const core::Camera& camera) {
  return std::visit([](const auto& c) { return Eigen::Vector2d(c.cx_px, c.cy_px); }, camera);
}

bool is_brown(const core::Camera& camera) {
  const auto* model = std::get_if<PinholeRadtan>(&camera);
  return model != nullptr && !is_rational(*model);
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
  const int width_px = picture_size_px(camera).x();
  core::require(width_px > 0, "a camera with a field of view knows the width of its pictures");
  // half a pixel more on both sides: pixels are as wide as they are apart
  if (const auto* fisheye = std::get_if<KannalaBrandt>(&camera)) {
    return straight_angle(*fisheye, std::abs(fisheye->cx_px + 0.5) / fisheye->fx_px) +
           straight_angle(*fisheye, std::abs(width_px - 0.5 - fisheye->cx_px) / fisheye->fx_px);
  }
  const PinholeRadtan& c = pinhole(camera);
  const double left_rad = std::atan((c.cx_px + 0.5) / c.fx_px);
  const double right_rad = std::atan((c.width_px - 0.5 - c.cx_px) / c.fx_px);
  return left_rad + right_rad;
}

}  // namespace samewhere::geometry
