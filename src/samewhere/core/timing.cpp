#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iterator>
#include <numeric>
#include <sstream>

#include <sys/resource.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

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
  for (const auto& [stage, processor_ms] : other.processor_ms_) {
    processor_ms_[stage] += processor_ms;
  }
  for (const auto& [stage, spans_ms] : other.spans_ms_) {
    auto& own = spans_ms_[stage];
    own.insert(own.end(), spans_ms.begin(), spans_ms.end());
  }
}

std::vector<double> Timings::durations_beside(const std::string& stage,
                                              const std::string& other) const {
  std::vector<double> beside_ms;
  if (!spans_ms_.contains(stage) || !spans_ms_.contains(other)) return beside_ms;
  const std::vector<Span>& others = spans_ms_.at(other);
  for (const Span& span : spans_ms_.at(stage)) {
    const bool is_beside = std::any_of(others.begin(), others.end(), [&](const Span& work) {
      return work.begin < span.end && span.begin < work.end;
    });
    if (is_beside) beside_ms.push_back(span.end - span.begin);
  }
  return beside_ms;
}

namespace {

double read_ms(clockid_t clock) {
  timespec spent{};
  clock_gettime(clock, &spent);
  return 1e3 * static_cast<double>(spent.tv_sec) + 1e-6 * static_cast<double>(spent.tv_nsec);
}

}  // namespace

double thread_processor_ms() { return read_ms(CLOCK_THREAD_CPUTIME_ID); }

double process_processor_ms() { return read_ms(CLOCK_PROCESS_CPUTIME_ID); }

std::optional<double> seconds_since_program_start() {
  // proc(5): the name of the program is in brackets and may hold anything; 19 fields after it, the
  // start in clock ticks since the machine's
  std::ifstream file("/proc/self/stat");
  const std::string stat((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  std::istringstream fields(stat.substr(std::min(stat.size(), stat.rfind(')') + 1)));
  std::string skipped;
  for (int i = 0; i < 19; ++i) fields >> skipped;
  double start_ticks = 0.0;
  if (!(fields >> start_ticks)) return std::nullopt;
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) -
         start_ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

double resident_memory_mib() {
  std::ifstream statm("/proc/self/statm");
  double total_pages = 0.0;
  double resident_pages = 0.0;
  if (!(statm >> total_pages >> resident_pages)) return 0.0;
  return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

void return_free_memory() {
#ifdef __GLIBC__
  constexpr std::size_t kKeepNothing = 0;
  malloc_trim(kKeepNothing);
#endif
}

}  // namespace samewhere::core
