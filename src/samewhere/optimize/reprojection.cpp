#include <cmath>

#include <samewhere/optimize/reprojection.hpp>

namespace samewhere::optimize {

Reprojection reproject(const core::PinholeRadtan& intrinsics, double baseline_m,
                       const Eigen::Vector3d& point_in_camera, const SeenAt& seen) {
  Reprojection r;
  const Eigen::Vector3d& p = point_in_camera;
  if (p.z() < kMinDepth_m) return r;

  const core::PinholeRadtan& c = intrinsics;
  const double inverse_z = 1.0 / p.z();
  const double x = c.fx_px * p.x() * inverse_z + c.cx_px;
  const double y = c.fy_px * p.y() * inverse_z + c.cy_px;
  const double disparity = c.fx_px * baseline_m * inverse_z;
  const bool has_depth = std::isfinite(seen.right_x_px);
  r.size = has_depth ? 3 : 2;
  r.value << x - seen.undistorted_px.x(), y - seen.undistorted_px.y(),
      has_depth ? x - disparity - seen.right_x_px : 0.0;

  r.by_point.row(0) << c.fx_px * inverse_z, 0.0, -c.fx_px * p.x() * inverse_z * inverse_z;
  r.by_point.row(1) << 0.0, c.fy_px * inverse_z, -c.fy_px * p.y() * inverse_z * inverse_z;
  if (has_depth) {
    r.by_point.row(2) = r.by_point.row(0);
    r.by_point(2, 2) += disparity * inverse_z;
  }
  r.value /= seen.sigma_px;
  r.by_point /= seen.sigma_px;
  return r;
}

}  // namespace samewhere::optimize
