#pragma once

#include <vector>

namespace samewhere::evaluate {

// Separation of true and false pairs by a score.
struct Separation {
  int num_true = 0;
  int num_wrong = 0;
  // Probability that a true pair scores above a false one, ties counting half (area under the ROC
  // curve; Mann and Whitney 1947). 0.5 if either kind is missing.
  double auc = 0.5;
  // True positive rate at a false positive rate of 1 % and of 0.1 %; with fewer than 1,000 false
  // pairs the latter is the rate without any false positive.
  double kept_at_1_percent = 0.0;
  double kept_at_0_1_percent = 0.0;
};

// Higher scores mean the same place. None may be NaN.
Separation separation_of(std::vector<double> true_scores, std::vector<double> wrong_scores);

}  // namespace samewhere::evaluate
