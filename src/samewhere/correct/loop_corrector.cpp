#include <algorithm>
#include <cmath>
#include <iterator>

#include <samewhere/core/errors.hpp>
#include <samewhere/correct/loop_corrector.hpp>
#include <samewhere/optimize/pose_graph.hpp>
#include <samewhere/optimize/spanning_tree.hpp>

namespace samewhere::correct {
namespace {

using scene::LoopEdge;
using scene::MapVersion;

optimize::PoseEdge as_edge(const LoopEdge& loop, const optimize::Config& config) {
  return {static_cast<int>(loop.match.index()),
          static_cast<int>(loop.query.index()),
          loop.match_from_query,
          loop.information,
          true,
          loop.log_scale,
          1.0 / (config.loop_scale_sigma * config.loop_scale_sigma)};
}

// Odometry measured both in one scale; log_scale has the corrections since.
optimize::PoseEdge odometry_edge(const MapVersion& map, const scene::Keyframe& keyframe,
                                 const optimize::Config& config) {
  const core::KeyframeId parent = keyframe.odometry->parent;
  return {static_cast<int>(parent.index()),
          static_cast<int>(keyframe.id.index()),
          settled_parent_from_keyframe(keyframe),
          keyframe.odometry->information,
          false,
          map.at(parent).log_scale - keyframe.log_scale,
          1.0 / (config.odometry_scale_sigma * config.odometry_scale_sigma)};
}

std::vector<scene::PoseChange> moves_to(const MapVersion& map, const optimize::PoseGraph& graph) {
  std::vector<scene::PoseChange> moves;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    if (!is_live(map.keyframes[i])) continue;
    const core::Rigid3 new_from_old =
        graph.world_from_node[i] * inverse(map.keyframes[i].world_from_body);
    moves.push_back({map.keyframes[i].id, new_from_old,
                     has_scales(graph) ? std::exp(graph.log_scales[i]) : 1.0});
  }
  return moves;
}

// The overruled loop and those that may depend on it: later queries, and loops closed since.
std::vector<LoopEdge> dependent_loops(const MapVersion& map, core::CandidateId overruled) {
  const auto first = std::find_if(map.loops.begin(), map.loops.end(),
                                  [&](const LoopEdge& known) { return known.cause == overruled; });
  std::vector<LoopEdge> dependent;
  if (first == map.loops.end()) return dependent;
  std::copy_if(map.loops.begin(), map.loops.end(), std::back_inserter(dependent),
               [&](const LoopEdge& known) {
                 return known.closed_at >= first->closed_at || known.query >= first->query;
               });
  return dependent;
}

// The map with these loops withdrawn.
MapVersion without(const MapVersion& map, const std::vector<LoopEdge>& loops) {
  if (loops.empty()) return map;
  scene::Edit edit;
  for (const auto& loop : loops) edit.withdrawn_loops.push_back(loop.cause);
  return apply(map, edit);
}

// Loops to be tested: the suspended ones and, as the last, the new one.
std::vector<LoopEdge> loops_to_test(const MapVersion& map, const LoopEdge& loop) {
  std::vector<LoopEdge> loops;
  for (const auto& suspended : map.suspended_loops)
    if (const auto edge = between_holders(map, suspended)) loops.push_back(*edge);
  loops.push_back(loop);
  return loops;
}

// Loops by their weight in the solved graph.
struct TestedLoops {
  std::vector<LoopEdge> accepted;
  std::vector<OutlierLoop> outliers;
};

// Of loops whose edges are consecutive in the graph.
TestedLoops tested(const std::vector<LoopEdge>& loops, std::size_t first_edge,
                   const optimize::PoseGraph& graph, const optimize::PoseGraphSummary& summary) {
  TestedLoops result;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (summary.weights[first_edge + i] > 0.0) {
      result.accepted.push_back(loops[i]);
    } else {
      result.outliers.push_back({loops[i], chi2_of(graph, graph.edges[first_edge + i])});
    }
  }
  return result;
}

bool is_last(const std::vector<OutlierLoop>& outliers, core::CandidateId cause) {
  return !outliers.empty() && outliers.back().loop.cause == cause;
}

}  // namespace

optimize::PoseGraph pose_graph_of(const MapVersion& map, const optimize::Config& config) {
  optimize::PoseGraph graph;
  if (has_scale_drift(map)) graph.log_scales.assign(map.keyframes.size(), 0.0);
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const scene::Keyframe& keyframe = map.keyframes[i];
    graph.world_from_node.push_back(keyframe.world_from_body);
    if (keyframe.odometry && is_live(keyframe))
      graph.edges.push_back(odometry_edge(map, keyframe, config));
  }
  for (const auto& known : map.loops) graph.edges.push_back(as_edge(known, config));
  return graph;
}

std::optional<LoopEdge> between_holders(const MapVersion& map, const LoopEdge& loop) {
  const scene::Holder match = holder_of(map, loop.match);
  const scene::Holder query = holder_of(map, loop.query);
  if (query.keyframe == match.keyframe) return std::nullopt;
  LoopEdge held = loop;
  held.query = query.keyframe;
  held.match = match.keyframe;
  held.match_from_query =
      match.holder_from_keyframe * loop.match_from_query * inverse(query.holder_from_keyframe);
  return held;
}

scene::Edit solve_poses(const MapVersion& map, const optimize::Config& config) {
  optimize::PoseGraph graph = pose_graph_of(map, config);
  solve_pose_graph(graph, config);
  scene::Edit edit;
  edit.pose_changes = moves_to(map, graph);
  return edit;
}

namespace {

// As solve_poses, of a map without a withdrawn loop, which had distorted the poses. Solved from the
// poses and from a spanning tree of odometry, which does not depend on that loop; the solution with
// the lower robust cost is taken.
scene::Edit solve_poses_without(const MapVersion& map, const optimize::Config& config) {
  optimize::PoseGraph from_poses = pose_graph_of(map, config);
  optimize::PoseGraph from_tree = from_poses;
  optimize::place_by_spanning_tree(from_tree);
  const double cost_from_poses = optimize::solve_pose_graph(from_poses, config).robust_cost;
  const bool is_tree_better =
      optimize::solve_pose_graph(from_tree, config).robust_cost < cost_from_poses;
  scene::Edit edit;
  edit.pose_changes = moves_to(map, is_tree_better ? from_tree : from_poses);
  return edit;
}

Closing solve_with_new_loop(const MapVersion& map, const LoopEdge& loop,
                            const optimize::Config& config) {
  optimize::PoseGraph graph = pose_graph_of(map, config);
  const std::size_t num_before = graph.edges.size();
  const std::vector<LoopEdge> loops = loops_to_test(map, loop);
  for (const auto& edge : loops) {
    graph.edges.push_back(as_edge(edge, config));
    graph.edges.back().is_suspended = edge.cause != loop.cause;
  }
  const optimize::PoseGraphSummary summary = solve_pose_graph(graph, config);

  const TestedLoops of_new = tested(loops, num_before, graph, summary);
  Closing closing;
  closing.accepted = of_new.accepted;
  if (is_last(of_new.outliers, loop.cause)) {
    closing.rejected = of_new.outliers.back();
    closing.edit.suspended_loops.push_back(loop);
  }
  if (closing.accepted.empty()) return closing;  // nothing contradicts the loops of the map
  closing.withdrawn = tested(map.loops, num_before - map.loops.size(), graph, summary).outliers;
  for (const auto& outlier : closing.withdrawn) {
    closing.edit.withdrawn_loops.push_back(outlier.loop.cause);
    closing.edit.suspended_loops.push_back(outlier.loop);
  }
  closing.edit.loops = closing.accepted;
  // withdrawal also drops results of bundle adjustment since the loop
  closing.edit.pose_changes =
      closing.withdrawn.empty()
          ? moves_to(map, graph)
          : solve_poses_without(apply(map, closing.edit), config).pose_changes;
  return closing;
}

// Loops that do not fit the poses of the map.
std::vector<OutlierLoop> find_outliers(const MapVersion& map, const std::vector<LoopEdge>& loops,
                                       const optimize::Config& config) {
  const optimize::PoseGraph graph = pose_graph_of(map, config);
  std::vector<OutlierLoop> outliers;
  for (const auto& loop : loops) {
    const double chi2 = chi2_of(graph, as_edge(loop, config));
    if (chi2 > config.loop_chi2) outliers.push_back({loop, chi2});
  }
  return outliers;
}

}  // namespace

Closing close_loop(const MapVersion& map, const LoopEdge& loop, const optimize::Config& config,
                   core::CandidateId overruled) {
  core::require(loop.cause.is_valid(), "a loop that is closed has a cause");
  core::require(is_live(map.at(loop.query)) && is_live(map.at(loop.match)),
                "a loop that is closed joins live keyframes");
  const std::vector<LoopEdge> dependent = dependent_loops(map, overruled);
  if (dependent.empty()) return solve_with_new_loop(map, loop, config);

  const MapVersion rest = without(map, dependent);
  Closing closing = solve_with_new_loop(rest, loop, config);
  if (closing.rejected) {  // suspended loops accepted without the overruled one do not count
    Closing unchanged;
    unchanged.rejected = closing.rejected;
    unchanged.edit.suspended_loops = {loop};
    return unchanged;
  }
  for (const auto& outlier : find_outliers(apply(rest, closing.edit), dependent, config)) {
    closing.edit.withdrawn_loops.push_back(outlier.loop.cause);
    closing.withdrawn.push_back(outlier);
  }
  closing.edit.pose_changes.clear();
  closing.edit.pose_changes = solve_poses_without(apply(map, closing.edit), config).pose_changes;
  return closing;
}

scene::Edit withdraw_loop(const MapVersion& map, core::CandidateId cause,
                          const optimize::Config& config) {
  scene::Edit edit;
  edit.withdrawn_loops = {cause};
  edit.pose_changes = solve_poses_without(apply(map, edit), config).pose_changes;
  return edit;
}

}  // namespace samewhere::correct
