#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <samewhere/verify/drift_path.hpp>
#include <samewhere/verify/look_alike.hpp>
#include <samewhere/verify/measure_odometry.hpp>
#include <samewhere/verify/odometry_chain.hpp>

namespace samewhere::verify {
namespace {

double least_certain_sigma_m(const core::Matrix6d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> of_position(covariance.topLeftCorner<3, 3>(),
                                                                   Eigen::EigenvaluesOnly);
  return std::sqrt(of_position.eigenvalues().maxCoeff());
}

// Of the query's pose in the match, from what the map knows to what the loop measures.
core::Vector6d correction_by(const scene::MapVersion& map, const scene::LoopEdge& claim) {
  const core::Rigid3 known =
      inverse(world_from_body(map, claim.match)) * world_from_body(map, claim.query);
  return difference(known, claim.match_from_query);
}

}  // namespace

core::OdometryEvidence measure_odometry_alone(const scene::MapVersion& map,
                                              const scene::LoopEdge& claim,
                                              const ScaleErrors& scale, const Config& config) {
  const core::Vector6d correction = correction_by(map, claim);
  core::OdometryEvidence evidence;
  evidence.correction_m = correction.head<3>().norm();
  evidence.correction_rad = correction.tail<3>().norm();
  if (const auto chain = odometry_between(map, claim.match, claim.query)) {
    const geometry::UncertainPose expected = expected_end(map, *chain, claim.log_scale, scale);
    const core::Vector6d error = difference(expected.a_from_b, claim.match_from_query);
    const core::Matrix6d covariance = expected.covariance + loop_information(config).inverse();
    evidence.mahalanobis_squared = error.dot(covariance.llt().solve(error));
    evidence.sigma_m = least_certain_sigma_m(covariance);
    evidence.look_alike_gain =
        look_alike_gain(error, covariance, least_look_alike_distance(map, config));
  }
  return evidence;
}

core::OdometryEvidence measure_odometry(const scene::MapVersion& map, const scene::LoopEdge& claim,
                                        const ScaleErrors& scale, const Config& config) {
  core::OdometryEvidence evidence = measure_odometry_alone(map, claim, scale, config);
  if (evidence.mahalanobis_squared > config.max_odometry_chi_square || map.loops.empty() ||
      has_scale_drift(map))
    return evidence;
  if (const auto drift = covariance_with_loops(map, claim.match, claim.query, scale.bias)) {
    const core::Vector6d correction = correction_by(map, claim);
    const core::Matrix6d covariance = *drift + loop_information(config).inverse();
    evidence.mahalanobis_squared_with_loops = correction.dot(covariance.llt().solve(correction));
    evidence.look_alike_gain_with_loops =
        look_alike_gain(correction, covariance, least_look_alike_distance(map, config));
    evidence.sigma_m = std::min(evidence.sigma_m.value_or(std::numeric_limits<double>::infinity()),
                                least_certain_sigma_m(covariance));
  }
  return evidence;
}

double least_look_alike_distance(const scene::MapVersion& map, const Config& config) {
  return has_scale_drift(map) ? config.min_look_alike_distance_without_depth
                              : config.min_look_alike_distance_m;
}

core::Matrix6d loop_information(const Config& config) {
  core::Vector6d diagonal;
  diagonal << Eigen::Vector3d::Constant(1.0 / (config.loop_sigma_m * config.loop_sigma_m)),
      Eigen::Vector3d::Constant(1.0 / (config.loop_sigma_rad * config.loop_sigma_rad));
  return diagonal.asDiagonal();
}

}  // namespace samewhere::verify
