#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <samewhere/paper/published.hpp>
#include <samewhere/paper/results.hpp>
#include <samewhere/report/table.hpp>

namespace samewhere::paper {
namespace {

nlohmann::json as_json(const ComparedMethod& method) {
  return {{"name", method.name}, {"title", method.title}, {"what_ran", method.what_ran}};
}

nlohmann::json as_json(const MissingRow& row) {
  return {{"recording", row.recording}, {"method", row.method}, {"reason", row.reason}};
}

nlohmann::json as_json(const PublishedSequence& sequence) {
  nlohmann::json json = {{"name", sequence.name},
                         {"auc_by_draws", sequence.auc_by_draws},
                         {"ms_by_draws", sequence.ms_by_draws},
                         {"loops", sequence.loops},
                         {"frames_per_second", sequence.frames_per_second}};
  for (std::size_t i = 0; i < kPublishedMethods.size(); ++i) {
    json["auc_by_method"][kPublishedMethods[i].ours] = sequence.auc_by_method[i];
    json["ms_by_method"][kPublishedMethods[i].ours] = sequence.ms_by_method[i];
  }
  for (const PublishedError& error : sequence.error_m)
    json["error_m"].push_back({error.max, error.min, error.median, error.rmse});
  return json;
}

nlohmann::json published_json() {
  nlohmann::json json = {{"draws", kPublishedNumDraws}, {"draws_of_use", kPublishedDrawsOfUse}};
  for (const PublishedSequence& sequence : kPublishedSequences)
    json["sequences"].push_back(as_json(sequence));
  for (const PublishedPoint& point : kPublishedPoints)
    json["points"].push_back({point.recall, point.precision});
  return json;
}

template <class T>
nlohmann::json array_of(const std::vector<T>& items) {
  nlohmann::json json = nlohmann::json::array();
  for (const T& item : items) json.push_back(as_json(item));
  return json;
}

std::string number(double value) { return fmt::format("{:.6f}", value); }

}  // namespace

nlohmann::json results_json(const Results& results) {
  return {{"version", 1},
          {"published", published_json()},
          {"recordings", results.recordings},
          {"methods", array_of(results.methods)},
          {"configurations", array_of(results.configurations)},
          {"recognition", results.recognition},
          {"slam", results.slam},
          {"missing", array_of(results.missing)}};
}

std::string recognition_csv(const Results& results) {
  report::Table table{
      {"recording", "window_frames", "method", "search", "draws", "seed", "queries",
       "queries_with_loop", "auc", "recall_at_full_precision", "precision_at_recall_35",
       "precision_at_recall_70", "loops_true", "loops_false", "loops_aliased", "loops_near",
       "ms_median", "ms_p95", "ms_p99"},
      {}};
  for (const RecognitionRow& row : results.recognition) {
    const core::TimingSummary& ms = row.ms.at(kTogether);
    table.rows.push_back(
        {row.recording, std::to_string(row.window_frames), row.method, name_of(row.search),
         std::to_string(row.num_draws), std::to_string(row.seed),
         std::to_string(row.result.num_queries), std::to_string(row.result.num_with_loop),
         number(row.result.auc), number(row.result.recall_at_full_precision),
         number(row.result.precision_at_recall_35), number(row.result.precision_at_recall_70),
         std::to_string(row.loops.num_true), std::to_string(row.loops.num_false),
         row.loops.num_aliased ? std::to_string(*row.loops.num_aliased) : "",
         std::to_string(row.loops.num_near), number(ms.median_ms), number(ms.p95_ms),
         number(ms.p99_ms)});
  }
  return report::as_csv(table);
}

std::string slam_csv(const Results& results) {
  report::Table table{{"recording", "configuration", "seed", "frames", "measured", "scale_free",
                       "ate_max_m", "ate_min_m", "ate_median_m", "ate_rmse_m", "loops_true",
                       "loops_false", "loops_unknown", "frames_per_second"},
                      {}};
  for (const SlamRow& row : results.slam) {
    const SlamError ate = row.ate_m.value_or(SlamError{});
    const auto metres = [&](double value) { return row.ate_m ? number(value) : std::string(); };
    table.rows.push_back({row.recording, row.configuration, std::to_string(row.seed),
                          std::to_string(row.num_frames), std::to_string(row.num_measured),
                          row.is_scale_free ? "1" : "0", metres(ate.max), metres(ate.min),
                          metres(ate.median), metres(ate.rmse), std::to_string(row.loops_true),
                          std::to_string(row.loops_false), std::to_string(row.loops_unknown),
                          number(row.frames_per_second)});
  }
  return report::as_csv(table);
}

}  // namespace samewhere::paper
