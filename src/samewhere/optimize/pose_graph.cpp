#include <algorithm>
#include <cmath>
#include <numeric>

#include <samewhere/core/errors.hpp>
#include <samewhere/optimize/edge_problem.hpp>
#include <samewhere/optimize/graduated_non_convexity.hpp>
#include <samewhere/optimize/pose_graph.hpp>
#include <samewhere/optimize/scaled_edge.hpp>

namespace samewhere::optimize {
namespace {

// Weight that the loss gives a loop edge in the solved graph.
double weight_of(double chi2, const Config& config) {
  switch (config.loop_loss) {
    case LoopLoss::kHuber:
      return std::min(1.0, config.loop_huber / std::sqrt(std::max(chi2, 1e-300)));
    case LoopLoss::kDcs: {
      const double scale = std::min(1.0, 2.0 * config.loop_dcs / (config.loop_dcs + chi2));
      return scale * scale;
    }
    default:
      return 1.0;
  }
}

}  // namespace

core::Vector6d edge_error(const PoseEdge& edge, const core::Rigid3& world_from_a,
                          const core::Rigid3& world_from_b) {
  const core::Rigid3 a_from_b = inverse(world_from_a) * world_from_b;
  core::Vector6d error;
  error << a_from_b.translation - edge.a_from_b.translation,
      core::log_so3(edge.a_from_b.rotation.conjugate() * a_from_b.rotation);
  return error;
}

double chi2_of(const PoseGraph& graph, const PoseEdge& edge) {
  const auto a = static_cast<std::size_t>(edge.a);
  const auto b = static_cast<std::size_t>(edge.b);
  if (!has_scales(graph)) {
    const core::Vector6d error =
        edge_error(edge, graph.world_from_node[a], graph.world_from_node[b]);
    return error.dot(edge.information * error);
  }
  const Vector7d error = scaled_edge_error(edge, {graph.world_from_node[a], graph.log_scales[a]},
                                           {graph.world_from_node[b], graph.log_scales[b]});
  return error.head<6>().dot(edge.information * error.head<6>()) +
         edge.scale_information * error(6) * error(6);
}

EdgeJacobians edge_jacobians(const PoseEdge& edge, const core::Rigid3& world_from_a,
                             const core::Rigid3& world_from_b) {
  const Eigen::Matrix3d a_from_world = world_from_a.rotation.conjugate().toRotationMatrix();
  const Eigen::Matrix3d b_from_world = world_from_b.rotation.conjugate().toRotationMatrix();
  const Eigen::Vector3d offset = world_from_b.translation - world_from_a.translation;
  const Eigen::Vector3d rotation_error = edge_error(edge, world_from_a, world_from_b).tail<3>();
  const Eigen::Matrix3d rotation_by_b = right_jacobian_inverse(rotation_error) * b_from_world;

  EdgeJacobians jacobians{core::Matrix6d::Zero(), core::Matrix6d::Zero()};
  jacobians.by_a.topLeftCorner<3, 3>() = -a_from_world;
  jacobians.by_a.topRightCorner<3, 3>() = a_from_world * core::skew(offset);
  jacobians.by_a.bottomRightCorner<3, 3>() = -rotation_by_b;
  jacobians.by_b.topLeftCorner<3, 3>() = a_from_world;
  jacobians.by_b.bottomRightCorner<3, 3>() = rotation_by_b;
  return jacobians;
}

namespace {

template <class Joins>
std::vector<int> components_by(const PoseGraph& graph, const Joins& joins) {
  std::vector<int> parent(graph.world_from_node.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root_of = [&](int node) {
    while (parent[static_cast<std::size_t>(node)] != node) {
      int& above = parent[static_cast<std::size_t>(node)];
      above = parent[static_cast<std::size_t>(above)];
      node = above;
    }
    return node;
  };
  for (const PoseEdge& edge : graph.edges) {
    if (!joins(edge)) continue;
    const auto [low, high] = std::minmax({root_of(edge.a), root_of(edge.b)});
    parent[static_cast<std::size_t>(high)] = low;
  }
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = root_of(static_cast<int>(i));
  return parent;
}

}  // namespace

std::vector<int> connected_components(const PoseGraph& graph) {
  return components_by(graph, [](const PoseEdge& /*edge*/) { return true; });
}

std::vector<int> odometry_components(const PoseGraph& graph) {
  return components_by(graph, [](const PoseEdge& edge) { return !edge.is_loop; });
}

std::vector<int> held_nodes(const PoseGraph& graph) {
  const std::vector<int> components = connected_components(graph);
  std::vector<int> held = graph.fixed_nodes;
  std::vector<bool> is_held(components.size(), false);
  for (const int node : graph.fixed_nodes)
    is_held.at(static_cast<std::size_t>(components.at(static_cast<std::size_t>(node)))) = true;
  for (std::size_t i = 0; i < components.size(); ++i) {
    const auto lowest = static_cast<std::size_t>(components[i]);
    if (!is_held[lowest]) held.push_back(components[i]);
    is_held[lowest] = true;
  }
  return held;
}

PoseGraphSummary solve_pose_graph(PoseGraph& graph, const Config& config) {
  if (config.loop_loss == LoopLoss::kGnc) return GraduatedNonConvexity(graph, config).solve();
  if (config.loop_loss == LoopLoss::kGncEach)
    return GraduatedNonConvexity(graph, config).solve_each();
  PoseGraphSummary summary = EdgeProblem(graph, config).solve(config.graph_iterations);
  summary.robust_cost = summary.final_cost;
  for (const PoseEdge& edge : graph.edges)
    summary.weights.push_back(edge.is_loop ? weight_of(chi2_of(graph, edge), config) : 1.0);
  return summary;
}

}  // namespace samewhere::optimize
