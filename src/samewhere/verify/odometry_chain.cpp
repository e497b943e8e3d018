#include <samewhere/verify/measure_odometry.hpp>
#include <samewhere/verify/odometry_chain.hpp>

namespace samewhere::verify {
namespace {

using geometry::UncertainPose;

UncertainPose edge_of(const scene::Keyframe& keyframe) {
  return {keyframe.odometry->parent_from_keyframe, keyframe.odometry->information.inverse()};
}

// Of the end's position in the beginning, if the scale crept by a share of 1 at each keyframe
// passed.
Eigen::Matrix3d covariance_of_creep(const scene::MapVersion& map, const OdometryChain& chain) {
  const core::Rigid3 begin_from_world = inverse(world_from_body(map, chain.begin));
  const Eigen::Vector3d there = world_from_body(map, chain.end).translation;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& id : chain.passed) {
    const Eigen::Vector3d rest =
        begin_from_world.rotation * (there - world_from_body(map, id).translation);
    covariance += rest * rest.transpose();
  }
  return covariance;
}

}  // namespace

bool ClimbingChain::climb(const scene::MapVersion& map) {
  const scene::Keyframe& keyframe = map.at(chain_.begin);
  if (!keyframe.odometry) return false;
  chain_.begin_from_end = compose(edge_of(keyframe), chain_.begin_from_end);
  chain_.passed.push_back(chain_.begin);
  chain_.begin = keyframe.odometry->parent;
  return true;
}

std::optional<OdometryChain> odometry_between(const scene::MapVersion& map, core::KeyframeId begin,
                                              core::KeyframeId end) {
  ClimbingChain to_begin(begin);
  ClimbingChain to_end(end);
  while (to_begin.begin() != to_end.begin()) {
    ClimbingChain& younger = to_end.begin() > to_begin.begin() ? to_end : to_begin;
    if (!younger.climb(map)) return std::nullopt;
  }
  OdometryChain chain = to_end.chain();
  chain.begin = begin;
  chain.begin_from_end =
      compose(inverse(to_begin.chain().begin_from_end), to_end.chain().begin_from_end);
  chain.passed.insert(chain.passed.end(), to_begin.chain().passed.begin(),
                      to_begin.chain().passed.end());
  return chain;
}

core::Matrix6d covariance_with_loop(const scene::MapVersion& map, const OdometryChain& chain,
                                    double scale_sigma, const Config& config) {
  core::Matrix6d covariance = chain.begin_from_end.covariance + loop_information(config).inverse();
  if (is_without_depth(map))
    covariance.topLeftCorner<3, 3>() += scale_sigma * scale_sigma * covariance_of_creep(map, chain);
  return covariance;
}

core::Vector6d difference(const core::Rigid3& known, const core::Rigid3& claimed) {
  core::Vector6d difference;
  difference << claimed.translation - known.translation,
      core::log_so3(known.rotation.conjugate() * claimed.rotation);
  return difference;
}

}  // namespace samewhere::verify
