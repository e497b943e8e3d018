#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <samewhere/pipeline/odometry_drift.hpp>
#include <samewhere/pipeline/soft_odometry.hpp>

namespace samewhere::pipeline {
namespace {

// What systematic drift grows with.
struct Travelled {
  double length_m = 0.0;
  double turned_rad = 0.0;
  double duration_s = 0.0;
};

Travelled travelled_on(const scene::MapVersion& map, const scene::Keyframe& keyframe) {
  const scene::OdometryEdge& edge = *keyframe.odometry;
  return {edge.parent_from_keyframe.translation.norm(),
          core::angle_rad(edge.parent_from_keyframe.rotation),
          std::abs(keyframe.view.stamp_s - map.at(edge.parent).view.stamp_s)};
}

// From the earliest match to the latest query.
Travelled longest_loop(const scene::MapVersion& map, const std::vector<scene::LoopEdge>& loops) {
  Travelled sum;
  if (loops.empty()) return sum;
  core::KeyframeId first = loops.front().match;
  core::KeyframeId last = loops.front().query;
  for (const scene::LoopEdge& loop : loops) {
    first = std::min({first, loop.match, loop.query});
    last = std::max({last, loop.match, loop.query});
  }
  for (std::size_t i = first.index() + 1; i <= last.index(); ++i) {
    const scene::Keyframe& keyframe = map.keyframes[i];
    if (!keyframe.odometry || !is_live(keyframe)) continue;
    const Travelled edge = travelled_on(map, keyframe);
    sum.length_m += edge.length_m;
    sum.turned_rad += edge.turned_rad;
    sum.duration_s += edge.duration_s;
  }
  return sum;
}

// The same shape, with so much more of the largest variance.
Eigen::Matrix3d enlarged(const Eigen::Matrix3d& covariance, double variance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return covariance * (1.0 + variance / solver.eigenvalues()(2));
}

core::Matrix6d softened(const core::Matrix6d& information, const Travelled& edge,
                        const Travelled& loop, const verify::SystematicDrift& drift) {
  const auto share = [](double rate, double part, double whole) {
    return rate * rate * part * whole;
  };
  core::Matrix6d covariance = information.inverse();
  covariance.topLeftCorner<3, 3>() = enlarged(covariance.topLeftCorner<3, 3>(),
                                              share(drift.per_metre, edge.length_m, loop.length_m));
  covariance.bottomRightCorner<3, 3>() =
      enlarged(covariance.bottomRightCorner<3, 3>(),
               share(drift.rad_per_metre, edge.length_m, loop.length_m) +
                   share(drift.rad_per_radian, edge.turned_rad, loop.turned_rad) +
                   share(drift.rad_per_s, edge.duration_s, loop.duration_s));
  return covariance.inverse();
}

}  // namespace

scene::MapVersion with_soft_odometry(const scene::MapVersion& map, const Config& config,
                                     const std::optional<scene::LoopEdge>& new_loop) {
  const verify::SystematicDrift drift = systematic_drift(config.odometry);
  if (drift.is_none()) return map;
  std::vector<scene::LoopEdge> loops = map.loops;
  loops.insert(loops.end(), map.suspended_loops.begin(), map.suspended_loops.end());
  if (new_loop) loops.push_back(*new_loop);
  const Travelled loop = longest_loop(map, loops);
  scene::MapVersion soft = map;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const scene::Keyframe& keyframe = map.keyframes[i];
    if (!keyframe.odometry || !is_live(keyframe)) continue;
    soft.keyframes.edit(i).odometry->information =
        softened(keyframe.odometry->information, travelled_on(map, keyframe), loop, drift);
  }
  return soft;
}

}  // namespace samewhere::pipeline
