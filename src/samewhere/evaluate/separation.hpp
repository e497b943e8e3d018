#pragma once

#include <vector>

namespace samewhere::evaluate {

// How well a score tells pairs of one place from pairs that only look alike.
struct Separation {
  int num_true = 0;
  int num_wrong = 0;
  // The chance that a true pair scores above a wrong one, a tie counting half (area under the ROC
  // curve; Mann and Whitney 1947). 0.5 if there are no pairs of one kind.
  double auc = 0.5;
  // Share of the true pairs above a threshold that so large a share of the wrong ones pass at most;
  // of fewer than 1,000 wrong pairs the second is of a threshold that none passes.
  double kept_at_1_percent = 0.0;
  double kept_at_0_1_percent = 0.0;
};

// Higher scores speak for one place. None may be NaN.
Separation separation_of(std::vector<double> true_scores, std::vector<double> wrong_scores);

}  // namespace samewhere::evaluate
