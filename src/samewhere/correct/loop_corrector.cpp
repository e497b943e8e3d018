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

// Odometry saw both in one scale, and what came since is counted.
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

// The overruled loop and those that came after it, on the path or in time.
std::vector<LoopEdge> suspects_of(const MapVersion& map, core::CandidateId overruled) {
  const auto first = std::find_if(map.loops.begin(), map.loops.end(),
                                  [&](const LoopEdge& known) { return known.cause == overruled; });
  std::vector<LoopEdge> suspects;
  if (first == map.loops.end()) return suspects;
  std::copy_if(map.loops.begin(), map.loops.end(), std::back_inserter(suspects),
               [&](const LoopEdge& known) {
                 return known.closed_at >= first->closed_at || known.query >= first->query;
               });
  return suspects;
}

// As if nobody had ever believed them.
MapVersion without(const MapVersion& map, const std::vector<LoopEdge>& loops) {
  if (loops.empty()) return map;
  scene::Edit edit;
  for (const auto& loop : loops) edit.withdrawn_loops.push_back(loop.cause);
  return apply(map, edit);
}

// Loops that the map does not believe yet: the doubted ones and the new one, which is the last.
std::vector<LoopEdge> claims_of(const MapVersion& map, const LoopEdge& loop) {
  std::vector<LoopEdge> claims;
  for (const auto& doubted : map.doubted_loops)
    if (const auto claim = between_holders(map, doubted)) claims.push_back(*claim);
  claims.push_back(loop);
  return claims;
}

// What the graph says of loops whose edges stand one after the other in it.
struct Answer {
  std::vector<LoopEdge> believed;
  std::vector<BentLoop> bent;
};

Answer answer_on(const std::vector<LoopEdge>& loops, std::size_t first_edge,
                 const optimize::PoseGraph& graph, const optimize::PoseGraphSummary& summary) {
  Answer answer;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (summary.weights[first_edge + i] > 0.0) {
      answer.believed.push_back(loops[i]);
    } else {
      answer.bent.push_back({loops[i], chi2_of(graph, graph.edges[first_edge + i])});
    }
  }
  return answer;
}

bool is_of(const std::vector<BentLoop>& bent, core::CandidateId cause) {
  return !bent.empty() && bent.back().loop.cause == cause;
}

}  // namespace

optimize::PoseGraph pose_graph_of(const MapVersion& map, const optimize::Config& config) {
  optimize::PoseGraph graph;
  if (is_without_depth(map)) graph.log_scales.assign(map.keyframes.size(), 0.0);
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
  return LoopEdge{
      query.keyframe,
      match.keyframe,
      match.holder_from_keyframe * loop.match_from_query * inverse(query.holder_from_keyframe),
      loop.information,
      loop.cause,
      loop.log_scale};
}

scene::Edit solve_poses(const MapVersion& map, const optimize::Config& config) {
  optimize::PoseGraph graph = pose_graph_of(map, config);
  solve_pose_graph(graph, config);
  scene::Edit edit;
  edit.pose_changes = moves_to(map, graph);
  return edit;
}

namespace {

// As solve_poses, of a map that has lost a loop. That had bent the poses, and from there a solver
// may not find back; where odometry leads, it was never there. Whichever start ends better.
scene::Edit solve_poses_without(const MapVersion& map, const optimize::Config& config) {
  optimize::PoseGraph bent = pose_graph_of(map, config);
  optimize::PoseGraph laid_out = bent;
  optimize::lay_out(laid_out);
  const double cost_of_bent = optimize::solve_pose_graph(bent, config).robust_cost;
  const bool is_better = optimize::solve_pose_graph(laid_out, config).robust_cost < cost_of_bent;
  scene::Edit edit;
  edit.pose_changes = moves_to(map, is_better ? laid_out : bent);
  return edit;
}

Closing close_among_known(const MapVersion& map, const LoopEdge& loop,
                          const optimize::Config& config) {
  optimize::PoseGraph graph = pose_graph_of(map, config);
  const std::size_t num_before = graph.edges.size();
  const std::vector<LoopEdge> claims = claims_of(map, loop);
  for (const auto& claim : claims) {
    graph.edges.push_back(as_edge(claim, config));
    graph.edges.back().is_doubted = claim.cause != loop.cause;
  }
  const optimize::PoseGraphSummary summary = solve_pose_graph(graph, config);

  const Answer on_claims = answer_on(claims, num_before, graph, summary);
  Closing closing;
  closing.believed = on_claims.believed;
  if (is_of(on_claims.bent, loop.cause)) {
    closing.refused = on_claims.bent.back();
    closing.edit.doubted_loops.push_back(loop);
  }
  if (closing.believed.empty()) return closing;  // nothing speaks against what was believed
  closing.withdrawn = answer_on(map.loops, num_before - map.loops.size(), graph, summary).bent;
  for (const auto& bent : closing.withdrawn) {
    closing.edit.withdrawn_loops.push_back(bent.loop.cause);
    closing.edit.doubted_loops.push_back(bent.loop);
  }
  closing.edit.loops = closing.believed;
  // a withdrawn loop takes with it what bundles found while it was there
  closing.edit.pose_changes =
      closing.withdrawn.empty()
          ? moves_to(map, graph)
          : solve_poses_without(apply(map, closing.edit), config).pose_changes;
  return closing;
}

// Those that contradict where the keyframes are.
std::vector<BentLoop> bent_in(const MapVersion& map, const std::vector<LoopEdge>& loops,
                              const optimize::Config& config) {
  const optimize::PoseGraph graph = pose_graph_of(map, config);
  std::vector<BentLoop> bent;
  for (const auto& loop : loops) {
    const double chi2 = chi2_of(graph, as_edge(loop, config));
    if (chi2 > config.loop_chi2) bent.push_back({loop, chi2});
  }
  return bent;
}

}  // namespace

Closing close_loop(const MapVersion& map, const LoopEdge& loop, const optimize::Config& config,
                   core::CandidateId overruled) {
  core::require(loop.cause.is_valid(), "a loop that is closed has a cause");
  core::require(is_live(map.at(loop.query)) && is_live(map.at(loop.match)),
                "a loop that is closed joins live keyframes");
  const std::vector<LoopEdge> suspects = suspects_of(map, overruled);
  if (suspects.empty()) return close_among_known(map, loop, config);

  const MapVersion standing = without(map, suspects);
  Closing closing = close_among_known(standing, loop, config);
  if (closing.refused) {  // the others were asked for its sake alone
    Closing nothing;
    nothing.refused = closing.refused;
    nothing.edit.doubted_loops = {loop};
    return nothing;
  }
  for (const auto& bent : bent_in(apply(standing, closing.edit), suspects, config)) {
    closing.edit.withdrawn_loops.push_back(bent.loop.cause);
    closing.withdrawn.push_back(bent);
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
