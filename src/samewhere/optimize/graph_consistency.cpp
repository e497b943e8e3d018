#include <algorithm>
#include <cmath>

#include <samewhere/optimize/graph_consistency.hpp>

namespace samewhere::optimize {
namespace {

// 99 % of chi-square: 3 and 7 degrees of freedom over 6
constexpr double kPlanarShare = 11.34 / 16.81;
constexpr double kScaledShare = 18.48 / 16.81;

}  // namespace

double degrees_of_freedom(const PoseGraph& graph) {
  if (graph.is_planar) return 3.0;
  return has_scales(graph) ? 7.0 : 6.0;
}

double chi2_limit(const PoseGraph& graph, const Config& config) {
  if (graph.is_planar) return kPlanarShare * config.loop_chi2;
  return (has_scales(graph) ? kScaledShare : 1.0) * config.loop_chi2;
}

bool is_consistent(const PoseGraph& graph, const Config& config, double chi2,
                   std::size_t num_rejected) {
  const auto num_loops = std::count_if(graph.edges.begin(), graph.edges.end(),
                                       [](const PoseEdge& edge) { return edge.is_loop; });
  const double num_measured = static_cast<double>(graph.edges.size());
  const double num_free =
      static_cast<double>(graph.world_from_node.size() - held_nodes(graph).size());
  const double expected = degrees_of_freedom(graph) * std::max(0.0, num_measured - num_free);
  return static_cast<double>(num_rejected) <=
             config.consistency.max_rejected_ratio * static_cast<double>(num_loops) &&
         chi2 <= expected + config.consistency.max_sigmas * std::sqrt(2.0 * expected);
}

}  // namespace samewhere::optimize
