#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/match_from_query.hpp>
#include <samewhere/report/funnel.hpp>
#include <samewhere/report/loops.hpp>

namespace samewhere::report {
namespace {

using Json = nlohmann::ordered_json;

void add_score(Json& scores, const char* name, double value) {
  if (std::isfinite(value)) scores[name] = value;
}

void add_odometry(Json& scores, const core::OdometryEvidence& odometry) {
  add_score(scores, "correction_m", odometry.correction_m);
  add_score(scores, "correction_rad", odometry.correction_rad);
  add_score(scores, "mahalanobis_squared", odometry.mahalanobis_squared);
  const auto add = [&](const char* name, const std::optional<double>& value) {
    if (value) add_score(scores, name, *value);
  };
  add("odometry_sigma_m", odometry.sigma_m);
  add("look_alike_gain", odometry.look_alike_gain);
  add("look_alike_gain_with_loops", odometry.look_alike_gain_with_loops);
  add("mahalanobis_squared_with_loops", odometry.mahalanobis_squared_with_loops);
  add("variance_factor", odometry.variance_factor);
}

void add_competing_loop(Json& scores, const core::CompetingLoopEvidence& loop) {
  scores["competing_loop"] = loop.frame.index();
  add_score(scores, "competing_loop_apart_m", loop.apart_m);
  add_score(scores, "competing_loop_apart_rad", loop.apart_rad);
  add_score(scores, "competing_loop_mahalanobis_squared", loop.mahalanobis_squared);
  if (!loop.gain) return;
  scores["competing_loop_first"] = loop.first_loop.index();
  add_score(scores, "competing_loop_gain", *loop.gain);
}

void add_competing_place(Json& scores, const core::CompetingPlaceEvidence& place) {
  scores["competing_place"] = place.frame.index();
  scores["competing_place_inliers"] = place.num_inliers;
  add_score(scores, "competing_place_apart_m", place.apart_m);
  add_score(scores, "competing_place_apart_rad", place.apart_rad);
}

// "num_matches" are those that "num_inliers" are of: the guided ones, if there are any; those of
// the descriptors alone are "num_first_matches" then. Without a geometry its scores are null.
void add_geometry(Json& scores, const core::GeometryEvidence& geometry) {
  const bool is_guided = geometry.num_guided_matches > 0;
  scores["num_matches"] = is_guided ? geometry.num_guided_matches : geometry.num_matches;
  if (is_guided) scores["num_first_matches"] = geometry.num_matches;
  scores["num_inliers"] = geometry.num_inliers;
  const bool is_measured = geometry.num_inliers > 0;
  const auto add = [&](const char* name, double value) {
    is_measured ? add_score(scores, name, value) : void(scores[name] = nullptr);
  };
  add("inlier_ratio", geometry.inlier_ratio);
  add("spread_ratio", geometry.spread_ratio);
  add("overlap_ratio", geometry.overlap_ratio);
  add("reprojection_rmse_px", geometry.reprojection_rmse_px);
  if (geometry.pose_difference_m)
    add_score(scores, "pose_difference_m", *geometry.pose_difference_m);
  if (geometry.pose_difference_rad)
    add_score(scores, "pose_difference_rad", *geometry.pose_difference_rad);
}

Json scores_json(const core::Verdict& verdict) {
  const core::Evidence& evidence = core::evidence_of(verdict);
  Json scores = Json::object();
  add_score(scores, "similarity", evidence.similarity);
  if (evidence.geometry) add_geometry(scores, *evidence.geometry);
  if (evidence.odometry) add_odometry(scores, *evidence.odometry);
  if (evidence.deformation) {
    add_score(scores, "deformation_rmse_m", evidence.deformation->rmse_m);
    add_score(scores, "deformation_path_m", evidence.deformation->path_m);
  }
  if (evidence.competing_loop) add_competing_loop(scores, *evidence.competing_loop);
  if (evidence.competing_place) add_competing_place(scores, *evidence.competing_place);
  if (evidence.sequence) {
    scores["query_view"] = evidence.sequence->query_view;
    scores["match_view"] = evidence.sequence->match_view;
    scores["num_sequence_views"] = evidence.sequence->num_views;
    scores["num_sequence_inliers"] = evidence.sequence->num_inliers;
  }
  const auto* loop = std::get_if<core::LoopClosure>(&verdict);
  const std::optional<core::Sim3> pose = core::match_from_query_of(verdict);
  if (pose && (pose->scale != 1.0 || (loop != nullptr && loop->scale_is_free)))
    add_score(scores, "scale", pose->scale);
  return scores;
}

Json pose_of(const core::Verdict& verdict) {
  const std::optional<core::Sim3> match_from_query = core::match_from_query_of(verdict);
  if (!match_from_query) return nullptr;
  const Eigen::Vector3d& t = match_from_query->translation;
  const Eigen::Quaterniond& q = match_from_query->rotation;
  return Json::array({t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()});
}

void add_sessions(Json& entry, const core::Candidate& candidate) {
  entry["query_session"] = candidate.query.session();
  entry["match_session"] = candidate.match.session();
}

Json entry_of(const core::LedgerRow& row) {
  Json entry = {{"query", row.candidate.query.index()},    {"match", row.candidate.match.index()},
                {"verdict", core::name_of(row.verdict)},   {"stage", core::stage_of(row.verdict)},
                {"reason", core::reason_of(row.verdict)},  {"scores", scores_json(row.verdict)},
                {"match_from_query", pose_of(row.verdict)}};
  const core::Candidate& candidate = row.candidate;
  if (candidate.query.session() != candidate.match.session()) add_sessions(entry, candidate);
  if (candidate.origin != core::Origin::kRetrieved)
    entry["origin"] = core::name_of(candidate.origin);
  const auto* loop = std::get_if<core::LoopClosure>(&row.verdict);
  if (loop != nullptr && loop->is_by_hand) entry["is_by_hand"] = true;
  if (loop != nullptr && loop->overruled.is_valid()) entry["overruled"] = loop->overruled.index();
  return entry;
}

// A name that is no UTF-8 must not cost the whole text.
std::string dumped(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string name_of_match(const core::Candidate& candidate) {
  const std::string index = std::to_string(candidate.match.index());
  if (candidate.match.session() == candidate.query.session()) return index;
  return fmt::format("{} of session {}", index, candidate.match.session());
}

std::string loops_json(const core::Ledger& ledger, bool is_scale_unknown) {
  Json candidates = Json::array();
  for (const core::LedgerRow* row : final_rows(ledger)) candidates.push_back(entry_of(*row));
  Json document = {{"version", kLoopsVersion}, {"candidates", std::move(candidates)}};
  if (is_scale_unknown) document["scale"] = "unknown";
  return dumped(document, 1) + "\n";
}

std::string ledger_row_json(const core::LedgerRow& row) {
  Json entry = entry_of(row);
  if (row.candidate.query.session() != 0) add_sessions(entry, row.candidate);
  return dumped(entry, -1);
}

std::string pairs_text(const std::vector<ScoredPair>& pairs) {
  std::string text;
  for (const ScoredPair& pair : pairs) {
    core::require(std::isfinite(pair.score), "the score of a match is a finite number");
    fmt::format_to(std::back_inserter(text), "{} {} {}\n", pair.query.index(), pair.match.index(),
                   pair.score);
  }
  return text;
}

}  // namespace samewhere::report
