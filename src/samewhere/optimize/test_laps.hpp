#pragma once

// For tests: pose graphs of laps around a square.

#include <cmath>
#include <vector>

#include <samewhere/core/random.hpp>
#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {

inline constexpr double kStepSigma_m = 0.05;
inline constexpr double kStepSigma_rad = 0.01;

inline core::Rigid3 odometry_noise(core::Random& random) {
  core::Vector6d tangent;
  for (int i = 0; i < 6; ++i)
    tangent(i) = (i < 3 ? kStepSigma_m : kStepSigma_rad) * random.gaussian();
  return core::exp_r3so3(tangent);
}

inline core::Matrix6d noise_information() {
  core::Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(kStepSigma_m), Eigen::Vector3d::Constant(kStepSigma_rad);
  return sigma.cwiseAbs2().cwiseInverse().asDiagonal();
}

// Laps around a square, with a loop from each pose of a later lap to the same place of the lap
// before.
struct Laps {
  PoseGraph graph;
  std::vector<core::Rigid3> truth;
  int num_loops = 0;
};

inline constexpr int kLapSteps = 40;

inline Laps laps(core::Random& random, int num_laps) {
  Laps walk;
  walk.truth = {core::Rigid3{}};
  PoseGraph& graph = walk.graph;
  graph.world_from_node = walk.truth;
  const auto add = [&](int a, int b, const core::Rigid3& a_from_b, bool is_loop) {
    graph.edges.push_back({a, b, a_from_b, noise_information(), is_loop});
  };
  for (int i = 1; i < num_laps * kLapSteps; ++i) {
    const core::Rigid3 step{core::exp_so3({0.0, i % 10 == 0 ? 1.5707963 : 0.0, 0.0}),
                            {0.0, 0.0, 1.0}};
    walk.truth.push_back(walk.truth.back() * step);
    add(i - 1, i, step * odometry_noise(random), false);
    graph.world_from_node.push_back(graph.world_from_node.back() * graph.edges.back().a_from_b);
  }
  for (int i = kLapSteps; i < num_laps * kLapSteps; ++i) {
    const auto at = [&](int node) { return walk.truth[static_cast<std::size_t>(node)]; };
    add(i - kLapSteps, i, inverse(at(i - kLapSteps)) * at(i) * odometry_noise(random), true);
    ++walk.num_loops;
  }
  return walk;
}

inline double ate_m(const Laps& walk) {
  double sum = 0.0;
  for (std::size_t i = 0; i < walk.truth.size(); ++i) {
    sum += (walk.graph.world_from_node[i].translation - walk.truth[i].translation).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(walk.truth.size()));
}

}  // namespace samewhere::optimize
