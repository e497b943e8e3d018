#pragma once

#include <vector>

namespace samewhere::evaluate {

// Mean and deviation over runs that differ in their seed only.
struct MeanDeviation {
  double mean = 0.0;
  double deviation = 0.0;  // of the sample (n - 1); 0 for a single run
};

// Of no values both are 0.
MeanDeviation mean_and_deviation(const std::vector<double>& values);

// Probability that `num_draws` draws with replacement from `num_queues` queues all miss a given
// one: (1 - 1 / num_queues)^num_draws. Both at least 1, or ContractError.
double chance_of_missing(int num_queues, int num_draws);

}  // namespace samewhere::evaluate
