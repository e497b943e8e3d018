#include <algorithm>
#include <cmath>
#include <vector>

#include <samewhere/correct/deformation.hpp>
#include <samewhere/correct/loop_corrector.hpp>
#include <samewhere/geometry/alignment.hpp>

namespace samewhere::correct {
namespace {

// Of the live keyframes from `first` to `last`.
std::vector<Eigen::Vector3d> positions(const scene::MapVersion& map,
                                       const optimize::PoseGraph& graph, std::size_t first,
                                       std::size_t last) {
  std::vector<Eigen::Vector3d> found;
  for (std::size_t i = first; i <= last; ++i)
    if (is_live(map.keyframes[i])) found.push_back(graph.world_from_node[i].translation);
  return found;
}

double length(const std::vector<Eigen::Vector3d>& path) {
  double sum = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i] - path[i - 1]).norm();
  return sum;
}

}  // namespace

std::optional<core::DeformationEvidence> measure_deformation(const scene::MapVersion& map,
                                                             const scene::LoopEdge& loop,
                                                             const optimize::Config& config) {
  const auto edge = between_holders(map, loop);
  if (!edge) return std::nullopt;
  scene::Edit edit;
  edit.loops.push_back(*edge);
  optimize::PoseGraph before = pose_graph_of(map, config);
  optimize::PoseGraph after = pose_graph_of(apply(map, edit), config);
  optimize::Config least_squares = config;
  least_squares.loop_loss = optimize::LoopLoss::kLeastSquares;
  optimize::solve_pose_graph(before, least_squares);
  optimize::solve_pose_graph(after, least_squares);
  const std::size_t first = std::min(edge->match, edge->query).index();
  const std::size_t last = std::max(edge->match, edge->query).index();
  const auto from = positions(map, before, first, last);
  const auto to = positions(map, after, first, last);
  if (from.size() < 3) return std::nullopt;
  const core::Sim3 aligned = geometry::align_points(from, to, false);
  double sum = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) sum += (aligned * from[i] - to[i]).squaredNorm();
  return core::DeformationEvidence{std::sqrt(sum / static_cast<double>(from.size())), length(from)};
}

}  // namespace samewhere::correct
