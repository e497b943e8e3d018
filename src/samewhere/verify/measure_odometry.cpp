#include <Eigen/Cholesky>

#include <samewhere/verify/measure_odometry.hpp>
#include <samewhere/verify/odometry_chain.hpp>

namespace samewhere::verify {

core::OdometryEvidence measure_odometry(const scene::MapVersion& map, const scene::LoopEdge& claim,
                                        double scale_sigma, const Config& config) {
  const core::Rigid3 known =
      inverse(world_from_body(map, claim.match)) * world_from_body(map, claim.query);
  const core::Vector6d correction = difference(known, claim.match_from_query);
  core::OdometryEvidence evidence;
  evidence.correction_m = correction.head<3>().norm();
  evidence.correction_rad = correction.tail<3>().norm();
  if (const auto chain = odometry_between(map, claim.match, claim.query)) {
    const core::Matrix6d covariance = covariance_with_loop(map, *chain, scale_sigma, config);
    evidence.mahalanobis_squared = correction.dot(covariance.llt().solve(correction));
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
