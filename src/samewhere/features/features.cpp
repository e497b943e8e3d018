#include <algorithm>

#include <samewhere/features/features.hpp>
#include <samewhere/geometry/camera.hpp>

namespace samewhere::features {

std::optional<Eigen::Vector3d> point_in_camera(const View& view, int feature) {
  const auto i = static_cast<std::size_t>(feature);
  const double depth_m = view.features->depth_m[i];
  if (depth_m <= 0.0 || !view.rig->is_calibrated()) return std::nullopt;
  const Eigen::Vector3d direction = geometry::bearing_of_undistorted(
      view.rig->cameras[0], view.features->undistorted_px[i].cast<double>());
  return direction * (depth_m / direction.z());
}

bool has_depth(const View& view) {
  const auto& depth_m = view.features->depth_m;
  return std::any_of(depth_m.begin(), depth_m.end(), [](float d) { return d > 0.0F; });
}

}  // namespace samewhere::features
