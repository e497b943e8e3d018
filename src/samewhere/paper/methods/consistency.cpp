#include <algorithm>
#include <cstdlib>
#include <utility>

#include <samewhere/paper/methods/consistency.hpp>

namespace samewhere::paper {

std::vector<ScoredBag> Consistency::consistent_of(const std::vector<ScoredBag>& candidates) {
  std::vector<Row> rows;
  std::vector<ScoredBag> consistent;
  for (const ScoredBag& candidate : candidates) {
    Row row{candidate.position, 0};
    for (const Row& before : rows_) {
      if (std::abs(before.position - candidate.position) <= max_gap_frames_)
        row.length = std::max(row.length, before.length + 1);
    }
    rows.push_back(row);
    if (row.length >= num_before_) consistent.push_back(candidate);
  }
  rows_ = std::move(rows);
  return consistent;
}

}  // namespace samewhere::paper
