#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
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

// A stage of the document.
struct StageTimes {
  std::string name;
  core::TimingSummary wall;
  double processor_ms = 0.0;
};

std::vector<StageTimes> stages_of(const nlohmann::json& document) {
  std::vector<StageTimes> stages;
  for (const auto& [name, stage] : document.at("stages").items()) {
    stages.push_back({name,
                      {.count = stage.at("count"),
                       .median_ms = stage.at("median_ms"),
                       .p95_ms = stage.at("p95_ms"),
                       .p99_ms = stage.at("p99_ms"),
                       .total_ms = stage.at("total_ms")},
                      stage.at("processor_ms")});
  }
  std::stable_sort(stages.begin(), stages.end(), [](const StageTimes& a, const StageTimes& b) {
    return a.processor_ms > b.processor_ms;
  });
  return stages;
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

Table stage_table(const std::string& json, const std::string& name) {
  Table table{{"stage", "calls", "median ms", "p95 ms", "p99 ms", "CPU time, ms / frame"}, {}};
  try {
    // sorted: a key is found at once, however many there are
    const auto document = nlohmann::json::parse(json);
    const std::vector<StageTimes> stages = stages_of(document);
    const auto frame = std::find_if(stages.begin(), stages.end(), [](const StageTimes& stage) {
      return stage.name == kWholeFrameStage;
    });
    const int num_frames = frame == stages.end() ? 0 : frame->wall.count;
    const auto ms = [](double value) { return fmt::format("{:.2f}", value); };
    for (const auto& stage : stages) {
      table.rows.push_back({stage.name, std::to_string(stage.wall.count), ms(stage.wall.median_ms),
                            ms(stage.wall.p95_ms), ms(stage.wall.p99_ms),
                            num_frames > 0 ? ms(stage.processor_ms / num_frames) : "-"});
    }
  } catch (const Json::exception&) {
    throw core::InputError(name +
                           ": not a timing.json; expected {\"version\": 1, \"stages\": {...}}");
  }
  return table;
}

}  // namespace samewhere::report
