#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include <samewhere/verify/expected_end.hpp>
#include <samewhere/verify/look_alike.hpp>
#include <samewhere/verify/measure_odometry.hpp>
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
std::optional<geometry::UncertainPose> by_odometry_alone(MapDrift& drift,
                                                         const scene::LoopEdge& claim) {
  return expected_end(drift, claim.match, claim.query, claim.log_scale, drift.scale());
}

// Scales the covariance of odometry by what loops have taught of it, and returns by how much.
std::optional<double> learn_from_loops(const scene::MapVersion& map, const Config& config,
                                       core::Matrix6d& covariance) {
  if (has_scale_drift(map)) return std::nullopt;
  const double factor = variance_factor(map, least_certain_sigma_m(covariance), config);
  covariance *= factor;
  return factor < 1.0 ? std::optional(factor) : std::nullopt;
}

core::OdometryEvidence measured_alone(const scene::MapVersion& map, const scene::LoopEdge& claim,
                                      const std::optional<geometry::UncertainPose>& known,
                                      const Config& config) {
  const core::Vector6d correction = correction_by(map, claim);
  core::OdometryEvidence evidence;
  evidence.correction_m = correction.head<3>().norm();
  evidence.correction_rad = correction.tail<3>().norm();
  if (!known) return evidence;
  const core::Vector6d error = difference(known->a_from_b, claim.match_from_query);
  const core::Matrix6d covariance = known->covariance + loop_information(config).inverse();
  evidence.mahalanobis_squared = error.dot(covariance.llt().solve(error));
  evidence.sigma_m = least_certain_sigma_m(covariance);
  evidence.look_alike_gain =
      look_alike_gain(error, covariance, least_look_alike_distance(map, config));
  return evidence;
}

}  // namespace

core::OdometryEvidence measure_odometry_alone(MapDrift& drift, const scene::LoopEdge& claim) {
  return measured_alone(drift.map(), claim, by_odometry_alone(drift, claim), drift.config());
}

core::OdometryEvidence measure_odometry(MapDrift& drift, const scene::LoopEdge& claim) {
  const scene::MapVersion& map = drift.map();
  const Config& config = drift.config();
  auto known = by_odometry_alone(drift, claim);
  std::optional<double> factor;
  if (known) factor = learn_from_loops(map, config, known->covariance);
  core::OdometryEvidence evidence = measured_alone(map, claim, known, config);
  evidence.variance_factor = factor;
  if (evidence.mahalanobis_squared > config.max_odometry_chi_square || map.loops.empty() ||
      has_scale_drift(map))
    return evidence;
  auto with_loops = drift.paths().covariance(claim.match, claim.query);
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

std::optional<scene::DriftSample> measure_drift(MapDrift& drift, const scene::LoopEdge& claim) {
  const scene::MapVersion& map = drift.map();
  if (has_scale_drift(map)) return std::nullopt;
  const auto known = by_odometry_alone(drift, claim);
  if (!known) return std::nullopt;
  std::optional<core::Matrix6d> with_loops;
  if (!map.loops.empty()) with_loops = drift.paths().covariance(claim.match, claim.query);
  return drift_sample(difference(known->a_from_b, claim.match_from_query), known->covariance,
                      with_loops, drift.config());
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
