#include <algorithm>
#include <cmath>
#include <numeric>

#include <sys/resource.h>

#include <samewhere/core/timing.hpp>

namespace samewhere::core {

TimingSummary summarize(std::vector<double> durations_ms) {
  if (durations_ms.empty()) return {};
  std::sort(durations_ms.begin(), durations_ms.end());
  const auto quantile = [&](double q) {
    const auto rank =
        static_cast<std::size_t>(std::ceil(q * static_cast<double>(durations_ms.size())));
    return durations_ms[std::max<std::size_t>(rank, 1) - 1];
  };
  return {static_cast<int>(durations_ms.size()), quantile(0.5), quantile(0.95), quantile(0.99),
          std::accumulate(durations_ms.begin(), durations_ms.end(), 0.0)};
}

void Timings::add(const Timings& other) {
  for (const auto& [stage, durations_ms] : other.durations_ms_) {
    auto& own = durations_ms_[stage];
    own.insert(own.end(), durations_ms.begin(), durations_ms.end());
  }
}

double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace samewhere::core
