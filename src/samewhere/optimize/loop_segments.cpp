#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <samewhere/optimize/loop_segments.hpp>

namespace samewhere::optimize {
namespace {

// Positions in RobustGraph::loops().
struct Segment {
  std::size_t begin = 0;
  std::size_t end = 0;
};

struct Conflict : Segment {
  int num_rejected = 0;
};

// The longest rows of rejected loops, the longest first.
std::vector<Conflict> find_conflicts(const RobustGraph& robust) {
  const LoopSegmentConfig& config = robust.config().loop_segments;
  const auto max_gap = static_cast<std::size_t>(config.max_conflict_gap);
  std::vector<Conflict> conflicts;
  for (std::size_t i = 0; i < robust.loops().size(); ++i) {
    const std::size_t loop = robust.loops()[i];
    if (robust.weight(loop) > 0.0 || robust.is_in_rejected_segment(loop)) continue;
    if (conflicts.empty() || i - conflicts.back().end > max_gap) conflicts.push_back({{i, i}, 0});
    conflicts.back().end = i + 1;
    ++conflicts.back().num_rejected;
  }
  std::erase_if(conflicts, [&](const Conflict& conflict) {
    return conflict.num_rejected < config.min_conflict_loops;
  });
  std::stable_sort(conflicts.begin(), conflicts.end(),
                   [](const Conflict& one, const Conflict& other) {
                     return one.num_rejected > other.num_rejected;
                   });
  conflicts.resize(std::min(conflicts.size(), static_cast<std::size_t>(config.max_conflicts)));
  return conflicts;
}

// The conflicts and both ends of the trajectory, in their order.
std::vector<Segment> bounds_of_segments(const RobustGraph& robust) {
  const std::vector<Conflict> conflicts = find_conflicts(robust);
  const std::size_t num_loops = robust.loops().size();
  std::vector<Segment> bounds(conflicts.begin(), conflicts.end());
  bounds.push_back({0, 0});
  bounds.push_back({num_loops, num_loops});
  std::stable_sort(bounds.begin(), bounds.end(), [](const Segment& one, const Segment& other) {
    return one.begin < other.begin;
  });
  return bounds;
}

// With the segments rejected before, fewer than half of the loops.
bool is_minority(const RobustGraph& robust, const Segment& segment) {
  const std::size_t num_rejected = robust.num_in_rejected_segments() + segment.end - segment.begin;
  return 2 * num_rejected < robust.loops().size();
}

// All segments between two conflicts.
std::vector<Segment> candidates_for_rejection(const RobustGraph& robust) {
  std::vector<Segment> candidates;
  const std::vector<Segment> bounds = bounds_of_segments(robust);
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    for (std::size_t j = i + 1; j < bounds.size(); ++j) {
      const Segment segment{bounds[i].end, bounds[j].begin};
      if (segment.begin < segment.end && is_minority(robust, segment))
        candidates.push_back(segment);
    }
  }
  return candidates;
}

// The candidates without which the cost is least before rejected loops are re-tested.
std::vector<Segment> best_candidates(RobustGraph& robust) {
  const RobustGraph::State before = robust.state();
  std::vector<std::pair<double, Segment>> by_cost;
  for (const Segment& segment : candidates_for_rejection(robust)) {
    robust.reject_segment(segment.begin, segment.end);
    by_cost.emplace_back(robust.truncated_cost(), segment);
    robust.restore(before);
  }
  std::stable_sort(by_cost.begin(), by_cost.end(),
                   [](const auto& one, const auto& other) { return one.first < other.first; });
  const auto max_trials = static_cast<std::size_t>(robust.config().loop_segments.max_trials);
  by_cost.resize(std::min(by_cost.size(), max_trials));
  std::vector<Segment> best;
  for (const auto& [cost, segment] : by_cost) best.push_back(segment);
  return best;
}

}  // namespace

bool reject_worst_segment(RobustGraph& robust) {
  const LoopSegmentConfig& config = robust.config().loop_segments;
  if (robust.num_rejected_segments() >= config.max_segments) return false;
  const RobustGraph::State before = robust.state();
  double best_cost = robust.truncated_cost() - config.min_gain * robust.limit();
  std::optional<RobustGraph::State> best;
  for (const Segment& segment : best_candidates(robust)) {
    robust.reject_segment(segment.begin, segment.end);
    robust.retest_rejected();
    const double cost = robust.truncated_cost();
    if (cost < best_cost) {
      best_cost = cost;
      best = robust.state();
    }
    robust.restore(before);
  }
  if (best) robust.restore(*best);
  return best.has_value();
}

}  // namespace samewhere::optimize
