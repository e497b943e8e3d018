#include <cmath>

#include <samewhere/optimize/scaled_edge.hpp>

namespace samewhere::optimize {

Vector7d scaled_edge_error(const PoseEdge& edge, const ScaledNode& a, const ScaledNode& b) {
  core::Rigid3 a_from_b = inverse(a.world_from_node) * b.world_from_node;
  a_from_b.translation *= std::exp(-a.log_scale);
  Vector7d error;
  error << edge_error(edge, core::Rigid3{}, a_from_b), b.log_scale - a.log_scale - edge.log_scale;
  return error;
}

ScaledEdgeJacobians scaled_edge_jacobians(const PoseEdge& edge, const ScaledNode& a,
                                          const ScaledNode& b) {
  const EdgeJacobians rigid = edge_jacobians(edge, a.world_from_node, b.world_from_node);
  const double a_units = std::exp(-a.log_scale);
  ScaledEdgeJacobians jacobians{Matrix7x6d::Zero(), Matrix7x6d::Zero(), Vector7d::Zero(),
                                Vector7d::Zero()};
  jacobians.by_a.topRows<6>() = rigid.by_a;
  jacobians.by_b.topRows<6>() = rigid.by_b;
  jacobians.by_a.topRows<3>() *= a_units;
  jacobians.by_b.topRows<3>() *= a_units;
  const core::Rigid3 a_from_b = inverse(a.world_from_node) * b.world_from_node;
  jacobians.by_scale_of_a.head<3>() = -a_units * a_from_b.translation;
  jacobians.by_scale_of_a(6) = -1.0;
  jacobians.by_scale_of_b(6) = 1.0;
  return jacobians;
}

}  // namespace samewhere::optimize
