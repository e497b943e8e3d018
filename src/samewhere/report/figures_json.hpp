#pragma once

#include <string>
#include <vector>

#include <samewhere/report/record.hpp>

namespace samewhere::report {

// Metrics for other programs: an object from the name of each metric to its printed value and the
// numbers in it, unrounded (null: not finite), in the order of the metrics. `title` names the run.
//   {"title": "office", "figures": {"ATE RMSE (median, max)": {"value": "0.01 m (0.01, 0.02)",
//   "numbers": [0.0133, 0.0126, 0.0254]}}}
std::string figures_json(const std::string& title, const std::vector<Figure>& figures);

}  // namespace samewhere::report
