#pragma once

#include <vector>

#include <samewhere/paper/methods/bag_of_words.hpp>

namespace samewhere::paper {

// Which candidates were near a candidate of the queries before, one after another (ORB-SLAM, 2015,
// section VII).
class Consistency {
 public:
  // Near: not farther apart than `max_gap_frames`. `num_before`: queries in a row.
  Consistency(int max_gap_frames, int num_before)
      : max_gap_frames_(max_gap_frames), num_before_(num_before) {}

  // The candidates of the next query, best first; those that are consistent, in their order. A
  // query without candidates ends all rows.
  std::vector<ScoredBag> consistent_of(const std::vector<ScoredBag>& candidates);

 private:
  struct Row {
    int position = 0;
    int length = 0;  // queries before
  };

  int max_gap_frames_;
  int num_before_;
  std::vector<Row> rows_;
};

}  // namespace samewhere::paper
