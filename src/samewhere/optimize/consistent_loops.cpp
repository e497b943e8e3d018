#include <algorithm>
#include <cstdlib>

#include <samewhere/optimize/consistent_loops.hpp>

namespace samewhere::optimize {
namespace {

constexpr int kNear = 50;  // nodes between their ends: what lies between is known well
constexpr std::size_t kMaxGroups = 20;

// With odometry between both their beginnings, and between both their ends.
bool are_on_one_stretch(const std::vector<int>& stretches, const PoseEdge& one,
                        const PoseEdge& other) {
  const auto is_one = [&](int node, int to) {
    return stretches[static_cast<std::size_t>(node)] == stretches[static_cast<std::size_t>(to)];
  };
  return is_one(one.a, other.a) && is_one(one.b, other.b);
}

bool agree(const PoseGraph& graph, const PoseEdge& one, const PoseEdge& other, double limit) {
  const int apart_at_a = std::abs(one.a - other.a);
  const int apart_at_b = std::abs(one.b - other.b);
  if (apart_at_a > kNear || apart_at_b > kNear) return false;
  const auto from = [&](int node, int to) {
    return inverse(graph.world_from_node[static_cast<std::size_t>(node)]) *
           graph.world_from_node[static_cast<std::size_t>(to)];
  };
  const core::Rigid3 foretold = from(other.a, one.a) * one.a_from_b * from(one.b, other.b);
  const core::Vector6d error = edge_error(other, core::Rigid3{}, foretold);
  return error.dot(other.information * error) <= (2.0 + apart_at_a + apart_at_b) * limit;
}

}  // namespace

std::vector<std::vector<std::size_t>> loops_that_agree(const PoseGraph& graph,
                                                       const std::vector<std::size_t>& edges,
                                                       double limit) {
  const std::vector<int> stretches = stretches_of(graph);
  std::vector<std::vector<std::size_t>> groups;
  for (const std::size_t edge : edges) {
    const auto known = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
      return std::any_of(group.begin(), group.end(), [&](std::size_t member) {
        return are_on_one_stretch(stretches, graph.edges[member], graph.edges[edge]) &&
               agree(graph, graph.edges[member], graph.edges[edge], limit);
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
  if (groups.size() > kMaxGroups) groups.resize(kMaxGroups);
  return groups;
}

}  // namespace samewhere::optimize
