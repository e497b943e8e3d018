#include <nlohmann/json.hpp>

#include <samewhere/paper/rows.hpp>

namespace samewhere::core {

void to_json(nlohmann::json& json, const TimingSummary& ms) {
  json = {{"count", ms.count},
          {"median", ms.median_ms},
          {"p95", ms.p95_ms},
          {"p99", ms.p99_ms},
          {"total", ms.total_ms}};
}

void from_json(const nlohmann::json& json, TimingSummary& ms) {
  json.at("count").get_to(ms.count);
  json.at("median").get_to(ms.median_ms);
  json.at("p95").get_to(ms.p95_ms);
  json.at("p99").get_to(ms.p99_ms);
  json.at("total").get_to(ms.total_ms);
}

}  // namespace samewhere::core

namespace samewhere::evaluate {

// A curve as [recall, precision, score].
void to_json(nlohmann::json& json, const PrecisionRecallPoint& point) {
  json = {point.recall, point.precision, point.score};
}

void from_json(const nlohmann::json& json, PrecisionRecallPoint& point) {
  json.at(0).get_to(point.recall);
  json.at(1).get_to(point.precision);
  json.at(2).get_to(point.score);
}

void to_json(nlohmann::json& json, const PrecisionRecall& result) {
  json = {{"auc", result.auc},
          {"recall_at_full_precision", result.recall_at_full_precision},
          {"precision_at_recall_35", result.precision_at_recall_35},
          {"precision_at_recall_70", result.precision_at_recall_70},
          {"queries", result.num_queries},
          {"queries_with_loop", result.num_with_loop},
          {"max_recall", result.max_recall},
          {"false_of_all", result.num_false},
          {"curve", result.curve}};
}

void from_json(const nlohmann::json& json, PrecisionRecall& result) {
  json.at("auc").get_to(result.auc);
  json.at("recall_at_full_precision").get_to(result.recall_at_full_precision);
  json.at("precision_at_recall_35").get_to(result.precision_at_recall_35);
  json.at("precision_at_recall_70").get_to(result.precision_at_recall_70);
  json.at("queries").get_to(result.num_queries);
  json.at("queries_with_loop").get_to(result.num_with_loop);
  json.at("max_recall").get_to(result.max_recall);
  json.at("false_of_all").get_to(result.num_false);
  json.at("curve").get_to(result.curve);
}

}  // namespace samewhere::evaluate

namespace samewhere::paper {

NLOHMANN_JSON_SERIALIZE_ENUM(SearchKind, {{SearchKind::kSampled, "sampled"},
                                          {SearchKind::kEveryQueue, "every queue"},
                                          {SearchKind::kExact, "exact"},
                                          {SearchKind::kOwn, "own"}})

std::string name_of(SearchKind search) { return nlohmann::json(search).get<std::string>(); }

static void to_json(nlohmann::json& json, const RecognitionLoops& loops) {
  json = {{"true", loops.num_true}, {"false", loops.num_false}, {"near", loops.num_near}};
  if (loops.num_aliased) json["aliased"] = *loops.num_aliased;
}

static void from_json(const nlohmann::json& json, RecognitionLoops& loops) {
  json.at("true").get_to(loops.num_true);
  json.at("false").get_to(loops.num_false);
  json.at("near").get_to(loops.num_near);
  if (json.contains("aliased")) loops.num_aliased = json.at("aliased").get<int>();
}

void to_json(nlohmann::json& json, const RecognitionRow& row) {
  json = {{"recording", row.recording},
          {"window_frames", row.window_frames},
          {"method", row.method},
          {"search", row.search},
          {"draws", row.num_draws},
          {"seed", row.seed},
          {"result", row.result},
          {"loops", row.loops},
          {"ms", row.ms}};
}

void from_json(const nlohmann::json& json, RecognitionRow& row) {
  json.at("recording").get_to(row.recording);
  json.at("window_frames").get_to(row.window_frames);
  json.at("method").get_to(row.method);
  json.at("search").get_to(row.search);
  json.at("draws").get_to(row.num_draws);
  json.at("seed").get_to(row.seed);
  json.at("result").get_to(row.result);
  json.at("loops").get_to(row.loops);
  json.at("ms").get_to(row.ms);
}

static void to_json(nlohmann::json& json, const PathPoint& point) {
  json = {point.estimate, point.truth};
}

static void from_json(const nlohmann::json& json, PathPoint& point) {
  json.at(0).get_to(point.estimate);
  json.at(1).get_to(point.truth);
}

static void to_json(nlohmann::json& json, const PathLoop& loop) {
  json = {{"query", loop.query}, {"match", loop.match}, {"false", loop.is_false}};
}

static void from_json(const nlohmann::json& json, PathLoop& loop) {
  json.at("query").get_to(loop.query);
  json.at("match").get_to(loop.match);
  json.at("false").get_to(loop.is_false);
}

void to_json(nlohmann::json& json, const SlamRow& row) {
  json = {{"recording", row.recording},
          {"configuration", row.configuration},
          {"seed", row.seed},
          {"frames", row.num_frames},
          {"measured", row.num_measured},
          {"scale_free", row.is_scale_free},
          {"loops_true", row.loops_true},
          {"loops_false", row.loops_false},
          {"loops_unknown", row.loops_unknown},
          {"frames_per_second", row.frames_per_second},
          {"path", row.path},
          {"loops", row.loops}};
  if (row.ate_m) {
    json["ate_m"] = {{"max", row.ate_m->max},
                     {"min", row.ate_m->min},
                     {"median", row.ate_m->median},
                     {"rmse", row.ate_m->rmse}};
  }
}

void from_json(const nlohmann::json& json, SlamRow& row) {
  json.at("recording").get_to(row.recording);
  json.at("configuration").get_to(row.configuration);
  json.at("seed").get_to(row.seed);
  json.at("frames").get_to(row.num_frames);
  json.at("measured").get_to(row.num_measured);
  json.at("scale_free").get_to(row.is_scale_free);
  json.at("loops_true").get_to(row.loops_true);
  json.at("loops_false").get_to(row.loops_false);
  json.at("loops_unknown").get_to(row.loops_unknown);
  json.at("frames_per_second").get_to(row.frames_per_second);
  json.at("path").get_to(row.path);
  json.at("loops").get_to(row.loops);
  if (!json.contains("ate_m")) return;
  const nlohmann::json& ate_m = json.at("ate_m");
  row.ate_m = {ate_m.at("max"), ate_m.at("min"), ate_m.at("median"), ate_m.at("rmse")};
}

}  // namespace samewhere::paper
