#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include <samewhere/geometry/uncertain_pose.hpp>
#include <samewhere/verify/drift_path.hpp>

namespace samewhere::verify {
namespace {

using geometry::UncertainPose;

// Of an error in rotation on the position later on the path, metres.
constexpr double kLever_m = 10.0;

constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();

}  // namespace

void DriftPaths::collect_edges() {
  edges_.resize(map_.keyframes.size());
  for (std::size_t i = 0; i < map_.keyframes.size(); ++i) {
    const scene::Keyframe& keyframe = map_.keyframes[i];
    if (keyframe.odometry)
      add_edge(keyframe.odometry->parent, keyframe.id, false,
               odometry_.edge_covariance(keyframe.id));
  }
  for (const scene::LoopEdge& loop : map_.loops)
    add_edge(loop.match, loop.query, true, loop.information.inverse());
}

void DriftPaths::add_edge(core::KeyframeId a, core::KeyframeId b, bool is_loop,
                          const core::Matrix6d& covariance) {
  const double cost = covariance.topLeftCorner<3, 3>().trace() +
                      kLever_m * kLever_m * covariance.bottomRightCorner<3, 3>().trace();
  edges_[a.index()].push_back({b.index(), is_loop, covariances_.size(), cost});
  edges_[b.index()].push_back({a.index(), is_loop, covariances_.size(), cost});
  covariances_.push_back(covariance);
}

// Dijkstra 1959. From the end back to the beginning; empty: they are not joined, or one.
std::vector<DriftPaths::Step> DriftPaths::steps_between(core::KeyframeId begin,
                                                        core::KeyframeId end) const {
  std::vector<double> costs(edges_.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> from(edges_.size(), kNowhere);
  std::vector<const Edge*> by(edges_.size(), nullptr);
  using Next = std::pair<double, std::size_t>;  // of equal costs the older keyframe
  std::priority_queue<Next, std::vector<Next>, std::greater<>> queue;
  costs[begin.index()] = 0.0;
  queue.emplace(0.0, begin.index());
  while (!queue.empty()) {
    const auto [cost, node] = queue.top();
    queue.pop();
    if (node == end.index()) break;
    if (cost > costs[node]) continue;
    for (const Edge& edge : edges_[node]) {
      const double sum = cost + edge.cost;
      if (sum >= costs[edge.to]) continue;
      costs[edge.to] = sum;
      from[edge.to] = node;
      by[edge.to] = &edge;
      queue.emplace(sum, edge.to);
    }
  }
  std::vector<Step> steps;
  for (std::size_t node = end.index(); node != begin.index(); node = from[node]) {
    if (by[node] == nullptr) return {};
    steps.push_back({map_.keyframes[node].id, map_.keyframes[from[node]].id, by[node]});
  }
  return steps;
}

std::optional<core::Matrix6d> DriftPaths::covariance(core::KeyframeId begin, core::KeyframeId end) {
  if (begin == end) return core::Matrix6d::Zero();
  if (edges_.empty()) collect_edges();
  const std::vector<Step> steps = steps_between(begin, end);
  if (steps.empty()) return std::nullopt;
  std::vector<std::vector<Step>> parts;  // between loops, and each loop
  for (const Step& step : steps) {
    const bool goes_on = !parts.empty() && !step.edge->is_loop && !parts.back()[0].edge->is_loop;
    if (!goes_on) parts.emplace_back();
    parts.back().push_back(step);
  }
  const auto num_runs = static_cast<double>(
      std::ranges::count_if(parts, [](const auto& part) { return !part[0].edge->is_loop; }));
  UncertainPose begin_from_end;
  for (const std::vector<Step>& part : parts)
    begin_from_end = compose(measured(part, num_runs), begin_from_end);
  return begin_from_end.covariance;
}

geometry::UncertainPose DriftPaths::measured(const std::vector<Step>& part, double num_runs) const {
  UncertainPose begin_from_end;
  for (const Step& step : part) {
    const core::Rigid3 before_from_here =
        inverse(world_from_body(map_, step.before)) * world_from_body(map_, step.here);
    begin_from_end = compose(UncertainPose{before_from_here, covariances_[step.edge->covariance]},
                             begin_from_end);
  }
  if (part[0].edge->is_loop) return begin_from_end;
  // the same errors in all runs: of their sum at most so many times the sum of the squares
  begin_from_end.covariance +=
      num_runs * odometry_.systematic_covariance(part.back().before, part[0].here);
  return begin_from_end;
}

}  // namespace samewhere::verify
