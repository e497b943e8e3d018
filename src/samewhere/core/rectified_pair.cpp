#include <cmath>

#include <fmt/format.h>

#include <samewhere/core/rectified_pair.hpp>

namespace samewhere::core {
namespace {

constexpr double kMaxDifference_px = 0.01;
constexpr double kMaxTurn_rad = 1e-4;        // a tenth of a pixel at a focal length of 1000
constexpr double kMaxSideways_ratio = 1e-3;  // a tenth of a pixel at a disparity of 100

bool has_distortion(const PinholeRadtan& camera) {
  return camera.k1 != 0.0 || camera.k2 != 0.0 || camera.p1 != 0.0 || camera.p2 != 0.0 ||
         camera.k3 != 0.0 || camera.k4 != 0.0 || camera.k5 != 0.0 || camera.k6 != 0.0;
}

bool is_near(double a_px, double b_px) { return std::abs(a_px - b_px) < kMaxDifference_px; }

bool has_same_intrinsics(const PinholeRadtan& a, const PinholeRadtan& b) {
  return a.width_px == b.width_px && a.height_px == b.height_px && is_near(a.fx_px, b.fx_px) &&
         is_near(a.fy_px, b.fy_px) && is_near(a.cx_px, b.cx_px) && is_near(a.cy_px, b.cy_px);
}

}  // namespace

Result<double, std::string> rectified_baseline_m(const Rig& rig) {
  if (rig.cameras.size() < 2) return refuse(std::string("there is no second camera"));
  const auto* first = std::get_if<PinholeRadtan>(&rig.cameras[0]);
  const auto* second = std::get_if<PinholeRadtan>(&rig.cameras[1]);
  if (first == nullptr || second == nullptr) return refuse(std::string("a lens is a fisheye"));
  const PinholeRadtan& left = *first;
  const PinholeRadtan& right = *second;
  if (has_distortion(left) || has_distortion(right)) {
    return refuse(std::string("the lenses distort"));
  }
  if (!has_same_intrinsics(left, right)) {
    return refuse(std::string("the cameras differ in size, focal length or centre"));
  }
  const Rigid3 left_from_right = inverse(rig.body_from_camera[0]) * rig.body_from_camera[1];
  const Eigen::Vector3d& baseline_m = left_from_right.translation;
  const double turn_rad = angle_rad(left_from_right.rotation);
  const bool is_beside =
      baseline_m.x() > 0.0 && baseline_m.tail<2>().norm() < kMaxSideways_ratio * baseline_m.x();
  if (turn_rad >= kMaxTurn_rad || !is_beside) {
    return refuse(fmt::format(
        "the right camera is turned by {:.5f} rad and lies at ({:.4f}, {:.4f}, {:.4f}) m, not to "
        "the right alone",
        turn_rad, baseline_m.x(), baseline_m.y(), baseline_m.z()));
  }
  constexpr double kMaxBaseline_m = 100.0;  // two cameras of one body
  if (baseline_m.x() > kMaxBaseline_m) {
    return refuse(fmt::format("the cameras are {:.4g} m apart, expected at most {} m",
                              baseline_m.x(), kMaxBaseline_m));
  }
  return baseline_m.x();
}

bool is_rectified_pair(const Rig& rig) { return rectified_baseline_m(rig).has_value(); }

}  // namespace samewhere::core
