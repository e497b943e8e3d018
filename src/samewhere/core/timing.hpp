#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace samewhere::core {

// Order statistics of durations, milliseconds.
struct TimingSummary {
  int count = 0;
  double median_ms = 0.0;
  double p95_ms = 0.0;
  double p99_ms = 0.0;
  double total_ms = 0.0;
};

TimingSummary summarize(std::vector<double> durations_ms);

// Wall time by stage. Never read by an algorithm: it ends in timing.json only.
class Timings {
 public:
  void add(const std::string& stage, double duration_ms) {
    durations_ms_[stage].push_back(duration_ms);
  }
  // All of another's, after its own: of a thread that had its own.
  void add(const Timings& other);
  const std::map<std::string, std::vector<double>>& durations_ms() const { return durations_ms_; }

 private:
  std::map<std::string, std::vector<double>> durations_ms_;
};

// Adds the time from its construction to its destruction.
class ScopedTimer {
 public:
  ScopedTimer(Timings& timings, std::string stage)
      : timings_(timings), stage_(std::move(stage)), start_(std::chrono::steady_clock::now()) {}
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;
  ~ScopedTimer() {
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - start_;
    timings_.add(stage_, elapsed.count());
  }

 private:
  Timings& timings_;
  std::string stage_;
  std::chrono::steady_clock::time_point start_;
};

// Highest resident memory of this process so far, MiB.
double peak_memory_mib();

}  // namespace samewhere::core
