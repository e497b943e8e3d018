#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include <samewhere/geometry/uncertain_pose.hpp>
#include <samewhere/verify/drift_path.hpp>

namespace samewhere::verify {
namespace {

using geometry::UncertainPose;

// Of an error in rotation on the position later on the path, metres.
constexpr double kLever_m = 10.0;

// An edge of the pose graph as seen from one of its ends.
struct Edge {
  std::size_t to = 0;
  core::Matrix6d information;
  double cost = 0.0;  // additive along a path: variance of a position kLever_m away, m^2
};

using Graph = std::vector<std::vector<Edge>>;

void add_edge(Graph& graph, core::KeyframeId a, core::KeyframeId b,
              const core::Matrix6d& information) {
  const core::Matrix6d covariance = information.inverse();
  const double cost = covariance.topLeftCorner<3, 3>().trace() +
                      kLever_m * kLever_m * covariance.bottomRightCorner<3, 3>().trace();
  graph[a.index()].push_back({b.index(), information, cost});
  graph[b.index()].push_back({a.index(), information, cost});
}

Graph graph_of(const scene::MapVersion& map) {
  Graph graph(map.keyframes.size());
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const scene::Keyframe& keyframe = map.keyframes[i];
    if (keyframe.odometry)
      add_edge(graph, keyframe.odometry->parent, keyframe.id, keyframe.odometry->information);
  }
  for (const scene::LoopEdge& loop : map.loops)
    add_edge(graph, loop.match, loop.query, loop.information);
  return graph;
}

// The edge by which each node is reached from `begin` at the least cost (Dijkstra 1959); itself
// where it is not.
struct Reached {
  std::vector<std::size_t> from;
  std::vector<const Edge*> by;
};

Reached least_cost_tree(const Graph& graph, std::size_t begin, std::size_t end) {
  std::vector<double> costs(graph.size(), std::numeric_limits<double>::infinity());
  Reached reached{std::vector<std::size_t>(graph.size(), 0),
                  std::vector<const Edge*>(graph.size(), nullptr)};
  using Next = std::pair<double, std::size_t>;  // of equal costs the older keyframe
  std::priority_queue<Next, std::vector<Next>, std::greater<>> queue;
  costs[begin] = 0.0;
  queue.emplace(0.0, begin);
  while (!queue.empty()) {
    const auto [cost, node] = queue.top();
    queue.pop();
    if (node == end) break;
    if (cost > costs[node]) continue;
    for (const Edge& edge : graph[node]) {
      const double sum = cost + edge.cost;
      if (sum >= costs[edge.to]) continue;
      costs[edge.to] = sum;
      reached.from[edge.to] = node;
      reached.by[edge.to] = &edge;
      queue.emplace(sum, edge.to);
    }
  }
  return reached;
}

}  // namespace

std::optional<core::Matrix6d> covariance_with_loops(const scene::MapVersion& map,
                                                    core::KeyframeId begin, core::KeyframeId end) {
  const Graph graph = graph_of(map);
  const Reached reached = least_cost_tree(graph, begin.index(), end.index());
  const auto pose_of = [&](std::size_t node) {
    return world_from_body(map, map.keyframes[node].id);
  };
  UncertainPose node_from_end;  // from the end back to the beginning
  for (std::size_t node = end.index(); node != begin.index();) {
    const Edge* edge = reached.by[node];
    if (edge == nullptr) return std::nullopt;
    const std::size_t before = reached.from[node];
    node_from_end = compose(
        UncertainPose{inverse(pose_of(before)) * pose_of(node), edge->information.inverse()},
        node_from_end);
    node = before;
  }
  return node_from_end.covariance;
}

}  // namespace samewhere::verify
