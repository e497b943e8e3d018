#pragma once

#include <optional>
#include <vector>

#include <samewhere/core/verdict.hpp>
#include <samewhere/geometry/uncertain_pose.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/verify/config.hpp>

// For the files of this folder that hold claims against odometry.

namespace samewhere::verify {

// What odometry alone measured from one keyframe to another, and the keyframes that it passed.
struct OdometryChain {
  core::KeyframeId begin;
  core::KeyframeId end;
  geometry::UncertainPose begin_from_end;
  std::vector<core::KeyframeId> passed;
};

// Through their youngest common ancestor; keyframes are older than their children. Nothing between
// keyframes without one (a new session): they know nothing of each other.
std::optional<OdometryChain> odometry_between(const scene::MapVersion& map, core::KeyframeId begin,
                                              core::KeyframeId end);

// A chain that ends with a keyframe and is made longer at its beginning, towards the origin.
class ClimbingChain {
 public:
  explicit ClimbingChain(core::KeyframeId end) { chain_.begin = chain_.end = end; }

  core::KeyframeId begin() const { return chain_.begin; }
  const OdometryChain& chain() const { return chain_; }
  // One edge more; false at the origin, which has none.
  bool climb(const scene::MapVersion& map);

 private:
  OdometryChain chain_;
};

// Of what odometry and a loop together know of the end in the beginning. Of a camera without depth,
// also what its scale may have crept: a share of scale_sigma at every keyframe passed, which
// stretches the rest of the way.
core::Matrix6d covariance_with_loop(const scene::MapVersion& map, const OdometryChain& chain,
                                    double scale_sigma, const Config& config);

// How far a claimed pose is from a known one [m in `begin`; rad].
core::Vector6d difference(const core::Rigid3& known, const core::Rigid3& claimed);

}  // namespace samewhere::verify
