#pragma once

#include <string>
#include <vector>

namespace samewhere::paper {

// "0.7865 ± 0.0100", without the deviation for a single value; "-" for none.
std::string mean_cell(const std::vector<double>& values, int num_digits);

// "0 of 35 false, at most 8.6 % at 95 %", "1 of 5 false (20.0 %)"; of independent trials.
std::string false_share(int num_false, int num_classified);

}  // namespace samewhere::paper
