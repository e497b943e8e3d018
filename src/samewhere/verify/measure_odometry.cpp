#include <Eigen/Cholesky>

#include <samewhere/verify/measure_odometry.hpp>
#include <samewhere/verify/odometry_chain.hpp>

namespace samewhere::verify {

core::OdometryEvidence measure_odometry(const scene::MapVersion& map, const scene::LoopEdge& claim,
                                        const ScaleErrors& scale, const Config& config) {
  const core::Rigid3 known =
      inverse(world_from_body(map, claim.match)) * world_from_body(map, claim.query);
  const core::Vector6d correction = difference(known, claim.match_from_query);
  core::OdometryEvidence evidence;
  evidence.correction_m = correction.head<3>().norm();
  evidence.correction_rad = correction.tail<3>().norm();
  if (const auto chain = odometry_between(map, claim.match, claim.query)) {
    const geometry::UncertainPose expected = expected_end(map, *chain, claim.log_scale, scale);
    const core::Vector6d error = difference(expected.a_from_b, claim.match_from_query);
    const core::Matrix6d covariance = expected.covariance + loop_information(config).inverse();
    evidence.mahalanobis_squared = error.dot(covariance.llt().solve(error));
  }
  return evidence;
}

core::Matrix6d loop_information(const Config& config) {
  core::Vector6d diagonal;
  diagonal << Eigen::Vector3d::Constant(1.0 / (config.loop_sigma_m * config.loop_sigma_m)),
      Eigen::Vector3d::Constant(1.0 / (config.loop_sigma_rad * config.loop_sigma_rad));
  return diagonal.asDiagonal();
}

}  // namespace samewhere::verify
