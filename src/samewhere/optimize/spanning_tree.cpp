#include <cmath>
#include <deque>
#include <vector>

#include <samewhere/core/errors.hpp>
#include <samewhere/optimize/spanning_tree.hpp>

namespace samewhere::optimize {
namespace {

class SpanningTree {
 public:
  SpanningTree(const SpanningTree&) = delete;
  SpanningTree& operator=(const SpanningTree&) = delete;
  explicit SpanningTree(PoseGraph& graph)
      : graph_(graph),
        edges_of_(graph.world_from_node.size()),
        is_placed_(graph.world_from_node.size(), false) {
    const auto is_node = [&](int node) {
      return node >= 0 && static_cast<std::size_t>(node) < graph.world_from_node.size();
    };
    for (const PoseEdge& edge : graph.edges) {
      core::require(is_node(edge.a) && is_node(edge.b), "an edge joins two nodes of the graph");
      edges_of_[static_cast<std::size_t>(edge.a)].push_back(&edge);
      edges_of_[static_cast<std::size_t>(edge.b)].push_back(&edge);
    }
  }

  // Breadth first; nodes that odometry reaches before those that only loops reach.
  void place_nodes() {
    for (const int node : held_nodes(graph_)) place(node);
    while (!odometry_.empty() || !loops_.empty()) {
      auto& next = odometry_.empty() ? loops_ : odometry_;
      const auto [edge, from] = next.front();
      next.pop_front();
      const int to = from == edge->a ? edge->b : edge->a;
      if (is_placed_[static_cast<std::size_t>(to)]) continue;
      if (to == edge->b) {
        compose_forward(*edge);
      } else {
        compose_backward(*edge);
      }
      place(to);
    }
  }

 private:
  struct Step {
    const PoseEdge* edge = nullptr;
    int from = 0;
  };

  void place(int node) {
    is_placed_[static_cast<std::size_t>(node)] = true;
    for (const PoseEdge* edge : edges_of_[static_cast<std::size_t>(node)])
      (edge->is_loop ? loops_ : odometry_).push_back({edge, node});
  }

  // In units of the world.
  core::Rigid3 a_from_b(const PoseEdge& edge) const {
    core::Rigid3 step = edge.a_from_b;
    if (has_scales(graph_))
      step.translation *= std::exp(graph_.log_scales[static_cast<std::size_t>(edge.a)]);
    return step;
  }

  void compose_forward(const PoseEdge& edge) {
    const auto a = static_cast<std::size_t>(edge.a);
    const auto b = static_cast<std::size_t>(edge.b);
    if (has_scales(graph_)) graph_.log_scales[b] = graph_.log_scales[a] + edge.log_scale;
    graph_.world_from_node[b] = graph_.world_from_node[a] * a_from_b(edge);
  }

  void compose_backward(const PoseEdge& edge) {
    const auto a = static_cast<std::size_t>(edge.a);
    const auto b = static_cast<std::size_t>(edge.b);
    if (has_scales(graph_)) graph_.log_scales[a] = graph_.log_scales[b] - edge.log_scale;
    graph_.world_from_node[a] = graph_.world_from_node[b] * inverse(a_from_b(edge));
  }

  PoseGraph& graph_;
  std::vector<std::vector<const PoseEdge*>> edges_of_;  // of a node
  std::vector<bool> is_placed_;
  std::deque<Step> odometry_;
  std::deque<Step> loops_;
};

}  // namespace

void place_by_spanning_tree(PoseGraph& graph) { SpanningTree(graph).place_nodes(); }

}  // namespace samewhere::optimize
