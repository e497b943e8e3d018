#include <cmath>
#include <deque>
#include <vector>

#include <samewhere/core/errors.hpp>
#include <samewhere/optimize/spanning_tree.hpp>

namespace samewhere::optimize {
namespace {

class Layout {
 public:
  explicit Layout(PoseGraph& graph)
      : graph_(graph),
        edges_of_(graph.world_from_node.size()),
        is_placed_(graph.world_from_node.size(), false) {
    const auto is_there = [&](int node) {
      return node >= 0 && static_cast<std::size_t>(node) < graph.world_from_node.size();
    };
    for (const PoseEdge& edge : graph.edges) {
      core::require(is_there(edge.a) && is_there(edge.b), "an edge joins nodes that are there");
      edges_of_[static_cast<std::size_t>(edge.a)].push_back(&edge);
      edges_of_[static_cast<std::size_t>(edge.b)].push_back(&edge);
    }
  }

  // What odometry reaches goes before what only loops do.
  void go() {
    for (const int node : held_nodes(graph_)) place(node);
    while (!near_.empty() || !beyond_.empty()) {
      auto& next = near_.empty() ? beyond_ : near_;
      const auto [edge, from] = next.front();
      next.pop_front();
      const int to = from == edge->a ? edge->b : edge->a;
      if (is_placed_[static_cast<std::size_t>(to)]) continue;
      if (to == edge->b) {
        follow(*edge);
      } else {
        follow_back(*edge);
      }
      place(to);
    }
  }

 private:
  struct Way {
    const PoseEdge* edge = nullptr;
    int from = 0;
  };

  void place(int node) {
    is_placed_[static_cast<std::size_t>(node)] = true;
    for (const PoseEdge* edge : edges_of_[static_cast<std::size_t>(node)])
      (edge->is_loop ? beyond_ : near_).push_back({edge, node});
  }

  // In units of the world.
  core::Rigid3 a_from_b(const PoseEdge& edge) const {
    core::Rigid3 step = edge.a_from_b;
    if (has_scales(graph_))
      step.translation *= std::exp(graph_.log_scales[static_cast<std::size_t>(edge.a)]);
    return step;
  }

  void follow(const PoseEdge& edge) {
    const auto a = static_cast<std::size_t>(edge.a);
    const auto b = static_cast<std::size_t>(edge.b);
    if (has_scales(graph_)) graph_.log_scales[b] = graph_.log_scales[a] + edge.log_scale;
    graph_.world_from_node[b] = graph_.world_from_node[a] * a_from_b(edge);
  }

  void follow_back(const PoseEdge& edge) {
    const auto a = static_cast<std::size_t>(edge.a);
    const auto b = static_cast<std::size_t>(edge.b);
    if (has_scales(graph_)) graph_.log_scales[a] = graph_.log_scales[b] - edge.log_scale;
    graph_.world_from_node[a] = graph_.world_from_node[b] * inverse(a_from_b(edge));
  }

  PoseGraph& graph_;
  std::vector<std::vector<const PoseEdge*>> edges_of_;  // of a node
  std::vector<bool> is_placed_;
  std::deque<Way> near_;    // over odometry
  std::deque<Way> beyond_;  // over loops
};

}  // namespace

void lay_out(PoseGraph& graph) { Layout(graph).go(); }

}  // namespace samewhere::optimize
