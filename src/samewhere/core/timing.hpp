#pragma once

#include <chrono>
#include <map>
#include <optional>
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

// Wall time by stage, and the processor time of the thread that spent it. Never read by an
// algorithm: it ends in timing.json only.
class Timings {
 public:
  void add(const std::string& stage, double duration_ms, double processor_ms = 0.0) {
    durations_ms_[stage].push_back(duration_ms);
    processor_ms_[stage] += processor_ms;
  }
  // Spent for the stage by another thread, while the stage's own went on.
  void add_processor(const std::string& stage, double processor_ms) {
    processor_ms_[stage] += processor_ms;
  }
  // All of another's, after its own: of a thread that had its own.
  void add(const Timings& other);
  const std::map<std::string, std::vector<double>>& durations_ms() const { return durations_ms_; }
  // Of all times of a stage together.
  const std::map<std::string, double>& processor_ms() const { return processor_ms_; }

 private:
  std::map<std::string, std::vector<double>> durations_ms_;
  std::map<std::string, double> processor_ms_;  // as many
};

// Processor time of the calling thread so far.
double thread_processor_ms();

// Adds the time from its construction to its destruction, both in one thread.
class ScopedTimer {
 public:
  ScopedTimer(Timings& timings, std::string stage)
      : timings_(timings),
        stage_(std::move(stage)),
        start_(std::chrono::steady_clock::now()),
        start_processor_ms_(thread_processor_ms()) {}
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;
  ~ScopedTimer() {
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - start_;
    timings_.add(stage_, elapsed.count(), thread_processor_ms() - start_processor_ms_);
  }

 private:
  Timings& timings_;
  std::string stage_;
  std::chrono::steady_clock::time_point start_;
  double start_processor_ms_;
};

// Highest resident memory of this process so far, MiB.
double peak_memory_mib();

// What was freed goes back to the system, as far as the allocator lets it. After large work: many
// small pieces that were needed at once would otherwise stay with the program for good.
void return_free_memory();

// Since this program was started, seconds, to a hundredth; nothing where the system does not say.
std::optional<double> seconds_since_program_start();

}  // namespace samewhere::core
