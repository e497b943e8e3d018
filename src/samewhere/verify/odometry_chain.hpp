#pragma once

#include <optional>
#include <vector>

#include <samewhere/core/verdict.hpp>
#include <samewhere/geometry/uncertain_pose.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/verify/config.hpp>
#include <samewhere/verify/measure_odometry.hpp>

// For the files of this folder that hold claims against odometry.

namespace samewhere::verify {

// What odometry alone measured from one keyframe to another, and its path from the end back to the
// beginning, both included.
struct OdometryChain {
  core::KeyframeId begin;
  core::KeyframeId end;
  geometry::UncertainPose begin_from_end;
  std::vector<core::KeyframeId> path;
};

// Through their youngest common ancestor; keyframes are older than their children. Nothing between
// keyframes without one (a new session): they know nothing of each other.
std::optional<OdometryChain> odometry_between(const scene::MapVersion& map, core::KeyframeId begin,
                                              core::KeyframeId end);

// A chain that ends with a keyframe and is made longer at its beginning, towards the origin.
class ClimbingChain {
 public:
  explicit ClimbingChain(core::KeyframeId end) {
    chain_.begin = chain_.end = end;
    chain_.path = {end};
  }

  core::KeyframeId begin() const { return chain_.begin; }
  const OdometryChain& chain() const { return chain_; }
  // One edge more; false at the origin, which has none.
  bool climb(const scene::MapVersion& map);

 private:
  OdometryChain chain_;
};

// Pose of the end in the beginning by the map, with the covariance of the chain. Without depth in
// the scale of the beginning, given a scale drift of exp(log_scale) along the chain: even over the
// keyframes plus a random part (a Brownian bridge), and none between the ends of a closed loop. The
// covariance is that of the chain, scaled with its length, and of the scale.
geometry::UncertainPose expected_end(const scene::MapVersion& map, const OdometryChain& chain,
                                     double log_scale, const ScaleErrors& scale);

// How far a claimed pose is from a known one [m in `begin`; rad].
core::Vector6d difference(const core::Rigid3& known, const core::Rigid3& claimed);

}  // namespace samewhere::verify
