#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include <samewhere/verify/drift_path.hpp>
#include <samewhere/verify/look_alike.hpp>
#include <samewhere/verify/measure_odometry.hpp>
#include <samewhere/verify/odometry_chain.hpp>
#include <samewhere/verify/variance_factor.hpp>

namespace samewhere::verify {
namespace {

// Of the query's pose in the match, from what the map knows to what the loop measures.
core::Vector6d correction_by(const scene::MapVersion& map, const scene::LoopEdge& claim) {
  const core::Rigid3 known =
      inverse(world_from_body(map, claim.match)) * world_from_body(map, claim.query);
  return difference(known, claim.match_from_query);
}

// The query's pose in the match by odometry alone. Nothing if that does not join the two.
std::optional<geometry::UncertainPose> drift_alone(const scene::MapVersion& map,
                                                   const scene::LoopEdge& claim,
                                                   const ScaleErrors& scale) {
  const auto chain = odometry_between(map, claim.match, claim.query);
  if (!chain) return std::nullopt;
  return expected_end(map, *chain, claim.log_scale, scale);
}

void learn_from_loops(const scene::MapVersion& map, const Config& config,
                      core::Matrix6d& covariance) {
  if (has_scale_drift(map)) return;
  covariance *= variance_factor(map, least_certain_sigma_m(covariance), config);
}

core::OdometryEvidence measured_alone(const scene::MapVersion& map, const scene::LoopEdge& claim,
                                      const std::optional<geometry::UncertainPose>& drift,
                                      const Config& config) {
  const core::Vector6d correction = correction_by(map, claim);
  core::OdometryEvidence evidence;
  evidence.correction_m = correction.head<3>().norm();
  evidence.correction_rad = correction.tail<3>().norm();
  if (!drift) return evidence;
  const core::Vector6d error = difference(drift->a_from_b, claim.match_from_query);
  const core::Matrix6d covariance = drift->covariance + loop_information(config).inverse();
  evidence.mahalanobis_squared = error.dot(covariance.llt().solve(error));
  evidence.sigma_m = least_certain_sigma_m(covariance);
  evidence.look_alike_gain =
      look_alike_gain(error, covariance, least_look_alike_distance(map, config));
  return evidence;
}

}  // namespace

core::OdometryEvidence measure_odometry_alone(const scene::MapVersion& map,
                                              const scene::LoopEdge& claim,
                                              const ScaleErrors& scale, const Config& config) {
  return measured_alone(map, claim, drift_alone(map, claim, scale), config);
}

core::OdometryEvidence measure_odometry(const scene::MapVersion& map, const scene::LoopEdge& claim,
                                        const ScaleErrors& scale, const Config& config) {
  DriftPaths paths(map);
  return measure_odometry(paths, claim, scale, config);
}

core::OdometryEvidence measure_odometry(DriftPaths& paths, const scene::LoopEdge& claim,
                                        const ScaleErrors& scale, const Config& config) {
  const scene::MapVersion& map = paths.map();
  auto drift = drift_alone(map, claim, scale);
  if (drift) learn_from_loops(map, config, drift->covariance);
  core::OdometryEvidence evidence = measured_alone(map, claim, drift, config);
  if (evidence.mahalanobis_squared > config.max_odometry_chi_square || map.loops.empty() ||
      has_scale_drift(map))
    return evidence;
  auto with_loops = paths.covariance(claim.match, claim.query, scale.bias);
  if (!with_loops) return evidence;
  learn_from_loops(map, config, *with_loops);
  const core::Vector6d correction = correction_by(map, claim);
  const core::Matrix6d covariance = *with_loops + loop_information(config).inverse();
  evidence.mahalanobis_squared_with_loops = correction.dot(covariance.llt().solve(correction));
  evidence.look_alike_gain_with_loops =
      look_alike_gain(correction, covariance, least_look_alike_distance(map, config));
  evidence.sigma_m = std::min(evidence.sigma_m.value_or(std::numeric_limits<double>::infinity()),
                              least_certain_sigma_m(covariance));
  return evidence;
}

std::optional<scene::DriftSample> measure_drift(const scene::MapVersion& map,
                                                const scene::LoopEdge& claim,
                                                const ScaleErrors& scale, const Config& config) {
  if (has_scale_drift(map)) return std::nullopt;
  const auto drift = drift_alone(map, claim, scale);
  if (!drift) return std::nullopt;
  std::optional<core::Matrix6d> with_loops;
  if (!map.loops.empty())
    with_loops = DriftPaths(map).covariance(claim.match, claim.query, scale.bias);
  return drift_sample(difference(drift->a_from_b, claim.match_from_query), drift->covariance,
                      with_loops, config);
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
