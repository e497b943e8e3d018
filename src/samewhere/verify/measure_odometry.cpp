#include <vector>

#include <Eigen/Cholesky>

#include <samewhere/geometry/uncertain_pose.hpp>
#include <samewhere/verify/measure_odometry.hpp>

namespace samewhere::verify {
namespace {

using geometry::UncertainPose;

UncertainPose edge_of(const scene::Keyframe& keyframe) {
  return {keyframe.odometry->parent_from_keyframe, keyframe.odometry->information.inverse()};
}

// Odometry from match to query, and the keyframes that it passes.
struct Chain {
  UncertainPose match_from_query;
  std::vector<core::KeyframeId> passed;
};

// Through their youngest common ancestor; keyframes are older than their children. Chains without a
// common ancestor (a new session) know nothing of each other: infinitely uncertain.
std::optional<Chain> odometry_between(const scene::MapVersion& map, core::KeyframeId query,
                                      core::KeyframeId match) {
  UncertainPose ancestor_from_query;
  UncertainPose ancestor_from_match;
  std::vector<core::KeyframeId> passed;
  while (query != match) {
    const bool climb_query = query > match;
    const scene::Keyframe& younger = map.at(climb_query ? query : match);
    if (!younger.odometry) return std::nullopt;
    UncertainPose& chain = climb_query ? ancestor_from_query : ancestor_from_match;
    chain = compose(edge_of(younger), chain);
    passed.push_back(younger.id);
    (climb_query ? query : match) = younger.odometry->parent;
  }
  return Chain{compose(inverse(ancestor_from_match), ancestor_from_query), passed};
}

// Of the query's position in the match, if the scale crept by a share of 1 at each keyframe passed.
Eigen::Matrix3d covariance_of_creep(const scene::MapVersion& map, const Chain& chain,
                                    const scene::LoopEdge& claim) {
  const core::Rigid3 match_from_world = inverse(world_from_body(map, claim.match));
  const Eigen::Vector3d end = world_from_body(map, claim.query).translation;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& id : chain.passed) {
    const Eigen::Vector3d rest =
        match_from_world.rotation * (end - world_from_body(map, id).translation);
    covariance += rest * rest.transpose();
  }
  return covariance;
}

}  // namespace

core::OdometryEvidence measure_odometry(const scene::MapVersion& map, const scene::LoopEdge& claim,
                                        double scale_sigma, const Config& config) {
  const core::Rigid3 known =
      inverse(world_from_body(map, claim.match)) * world_from_body(map, claim.query);
  core::Vector6d correction;
  correction << claim.match_from_query.translation - known.translation,
      core::log_so3(known.rotation.conjugate() * claim.match_from_query.rotation);

  core::OdometryEvidence evidence;
  evidence.correction_m = correction.head<3>().norm();
  evidence.correction_rad = correction.tail<3>().norm();
  if (const auto chain = odometry_between(map, claim.query, claim.match)) {
    core::Matrix6d covariance =
        chain->match_from_query.covariance + loop_information(config).inverse();
    if (is_without_depth(map))
      covariance.topLeftCorner<3, 3>() +=
          scale_sigma * scale_sigma * covariance_of_creep(map, *chain, claim);
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
