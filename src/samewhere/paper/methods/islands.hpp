#pragma once

#include <optional>
#include <vector>

#include <samewhere/paper/methods/bag_of_words.hpp>

namespace samewhere::paper {

// Neighbouring views that all look like a query (Galvez-Lopez and Tardos 2012).
struct Island {
  int begin = 0;  // first and last position
  int end = 0;
  double sum = 0.0;  // of the scores
  ScoredBag best;
};

// The island with the largest sum among views that score more than `min_score`; gaps within it are
// smaller than `gap_frames`. `scored` is in the order of positions. Nothing if none scores more.
std::optional<Island> best_island(const std::vector<ScoredBag>& scored, double min_score,
                                  int gap_frames);

// Whether they overlap or are at most so far apart.
bool are_near(const Island& a, const Island& b, int max_gap_frames);

}  // namespace samewhere::paper
