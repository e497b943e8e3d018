#include <samewhere/correct/loop_corrector.hpp>
#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::correct {
namespace {

optimize::PoseEdge as_edge(const scene::LoopEdge& loop) {
  return {static_cast<int>(loop.match.index()), static_cast<int>(loop.query.index()),
          loop.match_from_query, loop.information, true};
}

}  // namespace

optimize::PoseGraph pose_graph_of(const scene::MapVersion& map) {
  optimize::PoseGraph graph;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const scene::Keyframe& keyframe = map.keyframes[i];
    graph.world_from_node.push_back(keyframe.world_from_body);
    if (!keyframe.odometry || !is_live(keyframe)) continue;
    graph.edges.push_back({static_cast<int>(keyframe.odometry->parent.index()), static_cast<int>(i),
                           parent_from_keyframe(keyframe), keyframe.odometry->information, false});
  }
  for (const auto& known : map.loops) graph.edges.push_back(as_edge(known));
  return graph;
}

scene::Edit close_loop(const scene::MapVersion& map, const scene::LoopEdge& loop,
                       const optimize::Config& config) {
  optimize::PoseGraph graph = pose_graph_of(map);
  graph.edges.push_back(as_edge(loop));
  solve_pose_graph(graph, config);
  scene::Edit edit;
  edit.loops.push_back(loop);
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    if (!is_live(map.keyframes[i])) continue;
    const core::Rigid3 new_from_old =
        graph.world_from_node[i] * inverse(map.keyframes[i].world_from_body);
    edit.pose_changes.push_back({map.keyframes[i].id, new_from_old});
  }
  return edit;
}

}  // namespace samewhere::correct
