#pragma once

#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {

using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7x6d = Eigen::Matrix<double, 7, 6>;

// A node with a unit of length of its own: log_scale is the logarithm of that unit in units of the
// world, in which the pose is.
struct ScaledNode {
  core::Rigid3 world_from_node;
  double log_scale = 0.0;
};

// [translation in a, in its units; rotation on the right; log of b's unit in a's].
Vector7d scaled_edge_error(const PoseEdge& edge, const ScaledNode& a, const ScaledNode& b);

// Derivatives of the error, of the poses by retract().
struct ScaledEdgeJacobians {
  Matrix7x6d by_a;
  Matrix7x6d by_b;
  Vector7d by_scale_of_a;
  Vector7d by_scale_of_b;
};

ScaledEdgeJacobians scaled_edge_jacobians(const PoseEdge& edge, const ScaledNode& a,
                                          const ScaledNode& b);

}  // namespace samewhere::optimize
