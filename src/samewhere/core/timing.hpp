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

// Wall time by stage, and CPU time of the thread of the stage. Not read by any algorithm: output in
// timing.json only.
class Timings {
 public:
  void add(const std::string& stage, double duration_ms, double processor_ms = 0.0) {
    durations_ms_[stage].push_back(duration_ms);
    processor_ms_[stage] += processor_ms;
  }
  // The same, of which it is known when it was, on one clock for all.
  void add_span(const std::string& stage, double begin_ms, double end_ms, double processor_ms) {
    add(stage, end_ms - begin_ms, processor_ms);
    spans_ms_[stage].push_back({begin_ms, end_ms});
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
  // Of those times of a stage whose spans are known: those during which the other was at work, too.
  std::vector<double> durations_beside(const std::string& stage, const std::string& other) const;

 private:
  struct Span {
    double begin = 0.0;
    double end = 0.0;
  };

  std::map<std::string, std::vector<double>> durations_ms_;
  std::map<std::string, double> processor_ms_;  // as many
  std::map<std::string, std::vector<Span>> spans_ms_;
};

// Processor time of the calling thread so far, and of all threads of this process.
double thread_processor_ms();
double process_processor_ms();

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
    using Milliseconds = std::chrono::duration<double, std::milli>;
    const auto now = std::chrono::steady_clock::now();
    timings_.add_span(stage_, Milliseconds(start_.time_since_epoch()).count(),
                      Milliseconds(now.time_since_epoch()).count(),
                      thread_processor_ms() - start_processor_ms_);
  }

 private:
  Timings& timings_;
  std::string stage_;
  std::chrono::steady_clock::time_point start_;
  double start_processor_ms_;
};

// Highest resident memory of this process so far, MiB.
double peak_memory_mib();

// Resident memory of this process now, MiB; 0 where the system does not tell.
double resident_memory_mib();

// What was freed goes back to the system, as far as the allocator lets it. After large work: many
// small pieces that were needed at once would otherwise stay with the program for good.
void return_free_memory();

// Since this program was started, seconds, to a hundredth; nothing where the system does not say.
std::optional<double> seconds_since_program_start();

}  // namespace samewhere::core
