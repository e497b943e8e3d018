#include <algorithm>
#include <filesystem>
#include <map>

#include <fmt/format.h>

#include <samewhere/core/match_from_query.hpp>
#include <samewhere/report/figure.hpp>
#include <samewhere/report/frames.hpp>
#include <samewhere/report/funnel.hpp>
#include <samewhere/run/run_metrics.hpp>
#include <samewhere/verify/decide.hpp>

namespace samewhere::run {
namespace {

using report::figure;
using report::Figure;

int count_refused(const std::vector<const core::LedgerRow*>& rows, core::Refusal stage) {
  return static_cast<int>(std::count_if(rows.begin(), rows.end(), [&](const auto* row) {
    const auto* rejection = std::get_if<core::Rejection>(&row->verdict);
    return rejection != nullptr && rejection->stage == stage;
  }));
}

// Whether it came as far as the check whether the matches agree on one geometry.
bool has_matches(const core::Verdict& verdict) {
  const auto* rejection = std::get_if<core::Rejection>(&verdict);
  return rejection == nullptr || rejection->stage >= core::Refusal::kInliers;
}

std::vector<evaluate::Match> as_matches(const std::vector<report::ScoredPair>& pairs) {
  std::vector<evaluate::Match> matches;
  for (const auto& pair : pairs) {
    matches.push_back(
        {static_cast<int>(pair.query.index()), static_cast<int>(pair.match.index()), pair.score});
  }
  return matches;
}

Figure figure_of_share(const char* name, int part, int whole) {
  return figure(name, "{} of {} ({:.1f} %)", part, whole, whole > 0 ? 100.0 * part / whole : 0.0);
}

std::vector<Figure> figures_of_trajectory(const SlamEvaluation& evaluation) {
  std::vector<Figure> figures = {figure_of_share("frames with a measured pose",
                                                 evaluation.num_measured, evaluation.num_frames)};
  if (const auto& ate = evaluation.ate) {
    figures.push_back(figure(evaluation.is_scale_free ? "ATE RMSE (median, max), scale aligned"
                                                      : "ATE RMSE (median, max)",
                             "{:.4f} m ({:.4f}, {:.4f})", ate->rmse_m, ate->median_m, ate->max_m));
  }
  if (evaluation.path_m > 0.0) {
    figures.push_back(figure("path length", "{:.2f} m", evaluation.path_m));
  }
  if (const auto& ate = evaluation.odometry_ate) {
    figures.push_back(figure("ATE RMSE before loop closing", "{:.4f} m", ate->rmse_m));
  }
  if (const auto& drift = evaluation.drift_at_return) {
    figures.push_back(figure("drift at the first return", "{:.3f} m after {:.1f} m", drift->drift_m,
                             drift->path_m));
  }
  if (const auto& rpe = evaluation.rpe) {
    figures.push_back(figure("rotational error over 1 s, median (RMSE)", "{:.2f} degrees ({:.2f})",
                             rpe->rotation_median_deg, rpe->rotation_rmse_deg));
    figures.push_back(figure("translational error over 1 s, median (RMSE)", "{:.4f} m ({:.4f})",
                             rpe->translation_median_m, rpe->translation_rmse_m));
  }
  return figures;
}

evaluate::AcceptedLoop loop_of(const core::LedgerRow& row, const StampOf& stamp_of) {
  evaluate::AcceptedLoop loop;
  loop.query = static_cast<int>(row.candidate.query.index());
  loop.match = static_cast<int>(row.candidate.match.index());
  loop.query_stamp_s = stamp_of.at(row.candidate.query);
  loop.match_stamp_s = stamp_of.at(row.candidate.match);
  // of a relocalization the verdict may be ambiguous: its place is known, the evidence is not
  // enough
  const auto match_from_query = core::match_from_query_of(row.verdict);
  if (match_from_query) loop.match_from_query = rigid_part(*match_from_query);
  return loop;
}

// A relocalization, by one accepted relocalization candidate.
struct Relocalized {
  evaluate::AcceptedLoop loop;  // its pose is that of the trajectory, not of the candidate
  double apart_m = 0.0;         // between the two
};

std::optional<Relocalized> relocalization_of(const evaluate::AcceptedLoop& told,
                                             const core::Trajectory& trajectory) {
  const auto world_from_query = evaluate::truth_at(trajectory, told.query_stamp_s);
  const auto world_from_match = evaluate::truth_at(trajectory, told.match_stamp_s);
  if (!told.match_from_query || !world_from_query || !world_from_match) return std::nullopt;
  Relocalized found{told, 0.0};
  found.loop.match_from_query = inverse(*world_from_match) * *world_from_query;
  found.apart_m =
      (told.match_from_query->translation - found.loop.match_from_query->translation).norm();
  return found;
}

// Of candidates at the pose of the trajectory the earliest match: the visit that is joined. Else
// the nearest.
bool is_better(const Relocalized& a, const Relocalized& b) {
  constexpr double kThere_m = 0.2;
  const bool is_a_there = a.apart_m <= kThere_m;
  const bool is_b_there = b.apart_m <= kThere_m;
  if (is_a_there && is_b_there) return a.loop.match < b.loop.match;
  return a.apart_m < b.apart_m;
}

// Whether a relocalization in this revisit joined an earlier visit.
bool is_rejoined(const core::FrameSpan& revisit, const evaluate::LoopCheck& relocalized) {
  return std::any_of(relocalized.loops.begin(), relocalized.loops.end(), [&](const auto& checked) {
    return checked.truth == evaluate::LoopTruth::kTrue && checked.loop.match < revisit.first &&
           revisit.first <= checked.loop.query && checked.loop.query <= revisit.last;
  });
}

// Where the source knows its revisits, whose positions are those of its true poses.
std::optional<double> begin_of_revisits_s(const core::Truth& truth) {
  if (!truth.revisits || truth.revisits->empty()) return std::nullopt;
  const auto first = static_cast<std::size_t>(truth.revisits->front().first);
  if (first >= truth.trajectory.size()) return std::nullopt;
  return truth.trajectory[first].stamp_s;
}

Figure figure_of_drift(int num_edges, const evaluate::Consistency& drift) {
  return figure(
      num_edges == 1 ? "odometry NEES" : fmt::format("odometry NEES over {} edges", num_edges),
      "{:.1f} (consistent: 6, {:.1f} to {:.1f}; median {:.1f}; n = {})", drift.mean, drift.band_low,
      drift.band_high, drift.median, drift.num_motions);
}

std::optional<int> num_aliased_matching(const SlamFindings& findings, const core::Truth& truth) {
  if (truth.aliased_pairs.empty()) return std::nullopt;
  return static_cast<int>(
      std::count_if(findings.matching.begin(), findings.matching.end(), [&](const auto& pair) {
        return evaluate::is_aliased_pair(truth.aliased_pairs, pair.query, pair.match);
      }));
}

}  // namespace

void add_loops(const core::Ledger& ledger, const StampOf& stamp_of, SlamFindings& findings) {
  auto rows = report::final_rows(ledger);
  const auto own = std::stable_partition(rows.begin(), rows.end(), [](const core::LedgerRow* row) {
    return row->candidate.match.session() == row->candidate.query.session();
  });
  findings.num_of_known_map = static_cast<int>(rows.end() - own);
  findings.num_known_places =
      static_cast<int>(std::count_if(own, rows.end(), [](const core::LedgerRow* row) {
        return verify::is_recognized(row->verdict);
      }));
  rows.erase(own, rows.end());  // no truth knows the frames of another session
  findings.num_candidates = static_cast<int>(rows.size());
  findings.num_refused_by_graph = count_refused(rows, core::Refusal::kGraph);
  findings.num_withdrawn = count_refused(rows, core::Refusal::kWithdrawn);
  for (const auto* row : rows) {
    if (row->candidate.origin == core::Origin::kRelocalization) continue;  // a place, no loop
    if (has_matches(row->verdict)) {
      findings.matching.push_back({static_cast<int>(row->candidate.query.index()),
                                   static_cast<int>(row->candidate.match.index())});
    }
    if (core::is_loop(row->verdict)) findings.loops.push_back(loop_of(*row, stamp_of));
  }
}

void add_relocalized(const core::Ledger& ledger, const StampOf& stamp_of,
                     const std::set<core::FrameId>& resumed, SlamFindings& findings) {
  std::map<core::FrameId, Relocalized> best;
  for (const auto* row : report::final_rows(ledger)) {
    const core::Candidate& candidate = row->candidate;
    const bool is_told = candidate.origin == core::Origin::kRelocalization &&
                         verify::is_recognized(row->verdict) &&
                         candidate.match.session() == candidate.query.session();
    if (!is_told || !resumed.contains(candidate.query)) continue;
    const auto found = relocalization_of(loop_of(*row, stamp_of), findings.trajectory);
    if (!found) continue;
    const auto [it, is_first] = best.try_emplace(candidate.query, *found);
    if (!is_first && is_better(*found, it->second)) it->second = *found;
  }
  for (const auto& [frame, found] : best) findings.relocalized.push_back(found.loop);
}

SlamFindings findings_of(const report::RunRecord& record, bool is_scale_free) {
  SlamFindings findings;
  findings.num_frames = static_cast<int>(record.frames.size());
  findings.trajectory = report::measured_trajectory(record.frames);
  findings.odometry = record.odometry;
  findings.is_scale_free = is_scale_free;
  StampOf stamp_of;
  std::set<core::FrameId> resumed;
  for (const auto& frame : record.frames) {
    stamp_of[frame.pose.frame] = frame.pose.stamp_s;
    if (frame.pose.status == core::FrameStatus::kResumed) resumed.insert(frame.pose.frame);
  }
  add_loops(record.ledger, stamp_of, findings);
  add_relocalized(record.ledger, stamp_of, resumed, findings);
  return findings;
}

SlamEvaluation evaluate_slam(const SlamFindings& findings, const core::Truth& truth) {
  SlamEvaluation evaluation;
  evaluation.num_frames = findings.num_frames;
  evaluation.num_measured = static_cast<int>(findings.trajectory.size());
  evaluation.is_scale_free = findings.is_scale_free;
  const auto alignment =
      findings.is_scale_free ? evaluate::Alignment::kSim3 : evaluate::Alignment::kSe3;
  evaluation.ate = evaluate::ate(truth.trajectory, findings.trajectory, alignment);
  evaluation.odometry_ate = evaluate::ate(truth.trajectory, findings.odometry, alignment);
  if (!findings.is_scale_free) {
    evaluation.drift_at_return = evaluate::drift_at_first_return(
        truth.trajectory, findings.odometry, begin_of_revisits_s(truth));
  }
  if (evaluation.ate) {
    evaluation.path_m = evaluate::path_length_m(
        truth.trajectory, findings.trajectory.front().stamp_s, findings.trajectory.back().stamp_s);
  }
  const double scale = evaluation.ate ? evaluation.ate->scale : 1.0;
  evaluation.rpe = evaluate::rpe(truth.trajectory, findings.trajectory, 1.0, scale);
  evaluation.num_candidates = findings.num_candidates;
  evaluation.num_of_known_map = findings.num_of_known_map;
  evaluation.num_known_places = findings.num_known_places;
  evaluation.loops = evaluate::check_loops(findings.loops, truth, scale);
  evaluation.relocalized = evaluate::check_loops(findings.relocalized, truth, scale);
  for (const auto& revisit : truth.revisits.value_or(std::vector<core::FrameSpan>{})) {
    const bool is_joined = evaluate::is_closed(revisit, evaluation.loops.loops) ||
                           is_rejoined(revisit, evaluation.relocalized);
    evaluation.num_rejoined += is_joined ? 1 : 0;
  }
  evaluation.num_refused_by_graph = findings.num_refused_by_graph;
  evaluation.num_withdrawn = findings.num_withdrawn;
  evaluation.num_aliased_matching = num_aliased_matching(findings, truth);
  for (const auto& [num_edges, motions] : findings.odometry_chains) {
    if (const auto found = evaluate::consistency(motions, truth.trajectory))
      evaluation.drift_model[num_edges] = *found;
  }
  return evaluation;
}

std::set<core::CandidateId> false_loops_of(const core::Ledger& ledger,
                                           const SlamEvaluation& evaluation) {
  std::set<std::pair<int, int>> are_false;
  for (const evaluate::CheckedLoop& checked : evaluation.loops.loops) {
    if (checked.truth == evaluate::LoopTruth::kFalse)
      are_false.emplace(checked.loop.query, checked.loop.match);
  }
  std::set<core::CandidateId> ids;
  for (const core::LedgerRow* row : report::final_rows(ledger)) {
    const core::Candidate& candidate = row->candidate;
    const std::pair pair{static_cast<int>(candidate.query.index()),
                         static_cast<int>(candidate.match.index())};
    const bool is_own_loop = core::is_loop(row->verdict) &&
                             candidate.origin != core::Origin::kRelocalization &&
                             candidate.match.session() == candidate.query.session();
    if (is_own_loop && are_false.contains(pair)) ids.insert(candidate.id);
  }
  return ids;
}

core::Trajectory aligned_truth(const SlamEvaluation& evaluation, const core::Truth& truth) {
  if (!evaluation.ate) return {};
  const core::Sim3 estimate_from_truth = inverse(evaluation.ate->truth_from_estimate);
  core::Trajectory aligned = truth.trajectory;
  for (auto& pose : aligned) {
    const core::Sim3 placed = estimate_from_truth * core::Sim3::from_rigid(pose.world_from_camera);
    pose.world_from_camera = {placed.rotation, placed.translation};
  }
  return aligned;
}

RecognitionEvaluation evaluate_recognition(const RecognitionFindings& findings,
                                           const core::Truth& truth) {
  RecognitionEvaluation evaluation;
  evaluation.num_candidates = findings.num_candidates;
  evaluation.num_accepted = static_cast<int>(findings.accepted.size());
  if (truth.places) {
    evaluation.curve = evaluate::precision_recall(*truth.places, as_matches(findings.matches),
                                                  findings.window_frames);
    evaluation.accepted = evaluate::count_accepted(*truth.places, as_matches(findings.accepted),
                                                   findings.window_frames);
  }
  if (!truth.aliased_pairs.empty()) {
    evaluation.num_aliased = evaluate::count_accepted_aliased(
        truth.aliased_pairs, as_matches(findings.accepted), findings.window_frames);
  }
  return evaluation;
}

Figure describer_figure(const describe::Config& config, std::uint64_t checksum) {
  const std::string what = config.method == describe::Method::kAutoencoder
                               ? std::filesystem::path(config.network).filename().string()
                               : describe::kMethodNames.at(static_cast<std::size_t>(config.method));
  return {"describer", fmt::format("{:016x}, {}", checksum, what)};
}

std::vector<Figure> figures_of(const SlamEvaluation& evaluation) {
  std::vector<Figure> figures = figures_of_trajectory(evaluation);
  for (const auto& [num_edges, drift] : evaluation.drift_model)
    figures.push_back(figure_of_drift(num_edges, drift));
  const auto& loops = evaluation.loops;
  figures.push_back(figure("loop candidates", "{}", evaluation.num_candidates));
  figures.push_back(figure("loops accepted: true / false / unknown", "{} / {} / {}", loops.num_true,
                           loops.num_false, loops.num_unknown));
  if (evaluation.num_of_known_map > 0) {
    figures.push_back(figure("candidates in the loaded map / recognized", "{} / {}",
                             evaluation.num_of_known_map, evaluation.num_known_places));
  }
  if (evaluation.num_aliased_matching) {
    figures.push_back(figure("false loops between look-alike places", "{}", loops.num_aliased));
    figures.push_back(figure("look-alike candidates with enough matches", "{}",
                             *evaluation.num_aliased_matching));
  }
  if (loops.num_revisits > 0) {
    figures.push_back(figure("revisits closed", "{} of {}", loops.num_closed, loops.num_revisits));
  }
  if (const auto& again = evaluation.relocalized; !again.loops.empty()) {
    figures.push_back(figure("relocalizations: correct / wrong / unknown", "{} / {} / {}",
                             again.num_true, again.num_false, again.num_unknown));
    if (loops.num_revisits > 0) {
      figures.push_back(figure("revisits closed or relocalized", "{} of {}",
                               evaluation.num_rejoined, loops.num_revisits));
    }
  }
  if (evaluation.num_refused_by_graph + evaluation.num_withdrawn > 0) {
    figures.push_back(figure("loops rejected by the pose graph: at once / later", "{} / {}",
                             evaluation.num_refused_by_graph, evaluation.num_withdrawn));
  }
  return figures;
}

std::vector<Figure> figures_of(const RecognitionEvaluation& evaluation) {
  std::vector<Figure> figures = {figure("loop candidates", "{}", evaluation.num_candidates)};
  if (const auto& counts = evaluation.accepted) {
    figures.push_back(figure("accepted: true / false / near", "{} / {} / {}", counts->num_true,
                             counts->num_false, counts->num_near));
  } else {
    figures.push_back(figure("accepted", "{}", evaluation.num_accepted));
  }
  if (evaluation.num_aliased) {
    figures.push_back(
        figure("false loops between look-alike places", "{}", *evaluation.num_aliased));
  }
  if (const auto& curve = evaluation.curve) {
    figures.push_back(
        figure("queries, with a true loop", "{}, {}", curve->num_queries, curve->num_with_loop));
    figures.push_back(figure("AUC", "{:.4f}", curve->auc));
    figures.push_back(
        figure("recall at 100 % precision", "{:.4f}", curve->recall_at_full_precision));
    figures.push_back(figure("precision at recall .35, .70", "{:.4f}, {:.4f}",
                             curve->precision_at_recall_35, curve->precision_at_recall_70));
  }
  return figures;
}

}  // namespace samewhere::run
