#include <cmath>

#include <samewhere/core/errors.hpp>
#include <samewhere/evaluate/statistics.hpp>

namespace samewhere::evaluate {

MeanDeviation mean_and_deviation(const std::vector<double>& values) {
  if (values.empty()) return {};
  const auto count = static_cast<double>(values.size());
  MeanDeviation result;
  for (const double value : values) result.mean += value / count;
  if (values.size() == 1) return result;
  double sum = 0.0;
  for (const double value : values) sum += (value - result.mean) * (value - result.mean);
  result.deviation = std::sqrt(sum / (count - 1.0));
  return result;
}

double chance_of_missing(int num_queues, int num_draws) {
  core::require(num_queues >= 1 && num_draws >= 1, "there are queues and draws");
  return std::pow(1.0 - 1.0 / num_queues, num_draws);
}

}  // namespace samewhere::evaluate
