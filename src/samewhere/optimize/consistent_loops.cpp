#include <algorithm>
#include <cstdlib>

#include <samewhere/optimize/consistent_loops.hpp>

namespace samewhere::optimize {
namespace {

// Whether odometry joins both edges' ends a, and both their ends b.
bool are_joined_by_odometry(const std::vector<int>& components, const PoseEdge& one,
                            const PoseEdge& other) {
  const auto is_same = [&](int node, int to) {
    return components[static_cast<std::size_t>(node)] == components[static_cast<std::size_t>(to)];
  };
  return is_same(one.a, other.a) && is_same(one.b, other.b);
}

bool are_consistent(const PoseGraph& graph, const PoseEdge& one, const PoseEdge& other,
                    double limit, int max_gap_nodes) {
  const int gap_at_a = std::abs(one.a - other.a);
  const int gap_at_b = std::abs(one.b - other.b);
  if (gap_at_a > max_gap_nodes || gap_at_b > max_gap_nodes) return false;
  const auto from = [&](int node, int to) {
    return inverse(graph.world_from_node[static_cast<std::size_t>(node)]) *
           graph.world_from_node[static_cast<std::size_t>(to)];
  };
  const core::Rigid3 predicted = from(other.a, one.a) * one.a_from_b * from(one.b, other.b);
  const core::Vector6d error = edge_error(other, core::Rigid3{}, predicted);
  return error.dot(other.information * error) <= (2.0 + gap_at_a + gap_at_b) * limit;
}

}  // namespace

std::vector<std::vector<std::size_t>> consistent_loops(const PoseGraph& graph,
                                                       const std::vector<std::size_t>& edges,
                                                       double limit,
                                                       const LoopGroupConfig& config) {
  const std::vector<int> components = odometry_components(graph);
  std::vector<std::vector<std::size_t>> groups;
  for (const std::size_t edge : edges) {
    const auto known = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
      return std::any_of(group.begin(), group.end(), [&](std::size_t member) {
        return are_joined_by_odometry(components, graph.edges[member], graph.edges[edge]) &&
               are_consistent(graph, graph.edges[member], graph.edges[edge], limit,
                              config.max_gap_nodes);
      });
    });
    if (known == groups.end()) {
      groups.push_back({edge});
    } else {
      known->push_back(edge);
    }
  }
  std::erase_if(groups, [](const auto& group) { return group.size() < 2; });
  std::stable_sort(groups.begin(), groups.end(),
                   [](const auto& one, const auto& other) { return one.size() > other.size(); });
  const auto max_groups = static_cast<std::size_t>(config.max_groups);
  if (groups.size() > max_groups) groups.resize(max_groups);
  return groups;
}

}  // namespace samewhere::optimize
