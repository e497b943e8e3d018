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
  bool is_loop = false;
  const core::Matrix6d* information = nullptr;  // the map's
  double cost = 0.0;  // additive along a path: variance of a position kLever_m away, m^2
};

using Graph = std::vector<std::vector<Edge>>;

void add_edge(Graph& graph, core::KeyframeId a, core::KeyframeId b, bool is_loop,
              const core::Matrix6d& information) {
  const core::Matrix6d covariance = information.inverse();
  const double cost = covariance.topLeftCorner<3, 3>().trace() +
                      kLever_m * kLever_m * covariance.bottomRightCorner<3, 3>().trace();
  graph[a.index()].push_back({b.index(), is_loop, &information, cost});
  graph[b.index()].push_back({a.index(), is_loop, &information, cost});
}

Graph graph_of(const scene::MapVersion& map) {
  Graph graph(map.keyframes.size());
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const scene::Keyframe& keyframe = map.keyframes[i];
    if (keyframe.odometry)
      add_edge(graph, keyframe.odometry->parent, keyframe.id, false,
               keyframe.odometry->information);
  }
  for (const scene::LoopEdge& loop : map.loops)
    add_edge(graph, loop.match, loop.query, true, loop.information);
  return graph;
}

// The edge by which each node is reached from `begin` at the least cost, and the node before
// (Dijkstra 1959); no edge where it is not reached.
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

// Two neighbours on the path, the later one first.
struct Step {
  core::KeyframeId here;
  core::KeyframeId before;
  const Edge* edge = nullptr;
};

// From the end back to the beginning. Empty: they are not joined, or one.
std::vector<Step> steps_between(const scene::MapVersion& map, const Reached& reached,
                                core::KeyframeId begin, core::KeyframeId end) {
  std::vector<Step> steps;
  for (std::size_t node = end.index(); node != begin.index(); node = reached.from[node]) {
    if (reached.by[node] == nullptr) return {};
    steps.push_back(
        {map.keyframes[node].id, map.keyframes[reached.from[node]].id, reached.by[node]});
  }
  return steps;
}

// What the steps measure one by one: no constant error.
UncertainPose composed(const scene::MapVersion& map, const std::vector<Step>& steps) {
  UncertainPose begin_from_end;
  for (const Step& step : steps) {
    const core::Rigid3 before_from_here =
        inverse(world_from_body(map, step.before)) * world_from_body(map, step.here);
    begin_from_end =
        compose(UncertainPose{before_from_here, step.edge->information->inverse()}, begin_from_end);
  }
  return begin_from_end;
}

// The parts of the path between loops, and each loop.
std::vector<std::vector<Step>> parts_of(const std::vector<Step>& steps) {
  std::vector<std::vector<Step>> parts;
  for (const Step& step : steps) {
    const bool goes_on = !parts.empty() && !step.edge->is_loop && !parts.back()[0].edge->is_loop;
    if (!goes_on) parts.emplace_back();
    parts.back().push_back(step);
  }
  return parts;
}

}  // namespace

std::optional<core::Matrix6d> covariance_with_loops(const scene::MapVersion& map,
                                                    core::KeyframeId begin, core::KeyframeId end,
                                                    const SystematicDrift& bias) {
  if (begin == end) return core::Matrix6d::Zero();
  const Graph graph = graph_of(map);
  const std::vector<Step> steps =
      steps_between(map, least_cost_tree(graph, begin.index(), end.index()), begin, end);
  if (steps.empty()) return std::nullopt;
  const auto parts = parts_of(steps);
  const auto num_runs = static_cast<double>(
      std::ranges::count_if(parts, [](const auto& part) { return !part[0].edge->is_loop; }));
  UncertainPose begin_from_end;
  for (const std::vector<Step>& part : parts) {
    UncertainPose measured = composed(map, part);
    if (!part[0].edge->is_loop) {
      std::vector<core::KeyframeId> path = {part[0].here};
      for (const Step& step : part) path.push_back(step.before);
      // the same errors in all runs: of their sum at most so many times the sum of the squares
      measured.covariance += num_runs * systematic_covariance(map, path, bias);
    }
    begin_from_end = compose(measured, begin_from_end);
  }
  return begin_from_end.covariance;
}

}  // namespace samewhere::verify
