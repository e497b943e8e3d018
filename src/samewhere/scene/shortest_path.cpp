#include <deque>
#include <limits>
#include <vector>

#include <samewhere/core/errors.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {
namespace {

using Neighbours = std::vector<std::vector<std::size_t>>;  // of keyframes, by position

void join(Neighbours& neighbours, core::KeyframeId a, core::KeyframeId b) {
  neighbours[a.index()].push_back(b.index());
  neighbours[b.index()].push_back(a.index());
}

constexpr std::size_t kUnreached = std::numeric_limits<std::size_t>::max();

// Number of edges of the shortest path from a to b, breadth first.
std::size_t num_edges_between(const Neighbours& neighbours, std::size_t a, std::size_t b) {
  std::vector<std::size_t> num_edges(neighbours.size(), kUnreached);
  std::deque<std::size_t> next = {a};
  num_edges[a] = 0;
  while (!next.empty() && num_edges[b] == kUnreached) {
    const std::size_t here = next.front();
    next.pop_front();
    for (const std::size_t there : neighbours[here]) {
      if (num_edges[there] != kUnreached) continue;
      num_edges[there] = num_edges[here] + 1;
      next.push_back(there);
    }
  }
  return num_edges[b];
}

}  // namespace

bool shortest_path_uses_loop(const MapVersion& map, core::KeyframeId a, core::KeyframeId b) {
  core::require(is_live(map.at(a)) && is_live(map.at(b)), "a path joins two live keyframes");
  if (map.loops.empty()) return false;
  Neighbours neighbours(map.keyframes.size());
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const Keyframe& keyframe = map.keyframes[i];
    if (is_live(keyframe) && keyframe.odometry)
      join(neighbours, keyframe.odometry->parent, keyframe.id);
  }
  const std::size_t by_odometry = num_edges_between(neighbours, a.index(), b.index());
  for (const auto& loop : map.loops) join(neighbours, loop.query, loop.match);
  return num_edges_between(neighbours, a.index(), b.index()) < by_odometry;
}

}  // namespace samewhere::scene
