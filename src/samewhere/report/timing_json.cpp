#include <nlohmann/json.hpp>

#include <samewhere/report/record.hpp>
#include <samewhere/report/timing_json.hpp>

namespace samewhere::report {
namespace {

using Json = nlohmann::ordered_json;

Json summary_of(const core::TimingSummary& summary, double processor_ms) {
  return {{"count", summary.count},       {"median_ms", summary.median_ms},
          {"p95_ms", summary.p95_ms},     {"p99_ms", summary.p99_ms},
          {"total_ms", summary.total_ms}, {"processor_ms", processor_ms}};
}

Json frames_per_second(const core::Timings& timings) {
  const auto found = timings.durations_ms().find(kWholeFrameStage);
  if (found == timings.durations_ms().end()) return nullptr;
  const core::TimingSummary summary = core::summarize(found->second);
  if (summary.total_ms <= 0.0) return nullptr;
  return 1000.0 * summary.count / summary.total_ms;
}

}  // namespace

std::string timing_json(const core::Timings& timings, double peak_memory_mib) {
  Json stages = Json::object();
  for (const auto& [stage, durations_ms] : timings.durations_ms())
    stages[stage] = summary_of(core::summarize(durations_ms), timings.processor_ms().at(stage));
  const Json document = {{"version", 1},
                         {"frames_per_second", frames_per_second(timings)},
                         {"peak_memory_mib", peak_memory_mib},
                         {"stages", std::move(stages)}};
  return document.dump(1) + "\n";
}

}  // namespace samewhere::report
