#include <algorithm>

#include <samewhere/paper/methods/islands.hpp>

namespace samewhere::paper {

std::optional<Island> best_island(const std::vector<ScoredBag>& scored, double min_score,
                                  int gap_frames) {
  std::optional<Island> largest;
  std::optional<Island> open;
  const auto close = [&] {
    if (open && (!largest || open->sum > largest->sum)) largest = open;
  };
  for (const ScoredBag& view : scored) {
    if (view.score <= min_score) continue;
    if (!open || view.position - open->end >= gap_frames) {
      close();
      open = Island{.begin = view.position, .end = view.position, .sum = 0.0, .best = view};
    }
    open->end = view.position;
    open->sum += view.score;
    if (view.score > open->best.score) open->best = view;
  }
  close();
  return largest;
}

bool are_near(const Island& a, const Island& b, int max_gap_frames) {
  return std::max(b.begin - a.end, a.begin - b.end) <= max_gap_frames;
}

}  // namespace samewhere::paper
