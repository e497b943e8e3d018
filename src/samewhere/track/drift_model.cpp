#include <samewhere/track/drift_model.hpp>

namespace samewhere::track {

core::Matrix6d odometry_information(const core::Rigid3& reference_from_frame, bool is_weak,
                                    const DriftConfig& config) {
  const double factor = is_weak ? config.weak_factor : 1.0;
  const double sigma_m =
      factor * (config.base_m + config.per_metre * reference_from_frame.translation.norm());
  const double sigma_rad =
      factor *
      (config.base_rad + config.per_radian * core::angle_rad(reference_from_frame.rotation));
  core::Vector6d diagonal;
  diagonal << Eigen::Vector3d::Constant(1.0 / (sigma_m * sigma_m)),
      Eigen::Vector3d::Constant(1.0 / (sigma_rad * sigma_rad));
  return diagonal.asDiagonal();
}

}  // namespace samewhere::track
