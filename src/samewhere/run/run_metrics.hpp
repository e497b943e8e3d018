#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include <samewhere/core/truth.hpp>
#include <samewhere/describe/config.hpp>
#include <samewhere/evaluate/consistency.hpp>
#include <samewhere/evaluate/drift_at_return.hpp>
#include <samewhere/evaluate/loop_check.hpp>
#include <samewhere/evaluate/precision_recall.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/report/record.hpp>

namespace samewhere::run {

// What SLAM says, as far as it can be compared with a truth.
struct SlamFindings {
  int num_frames = 0;
  core::Trajectory trajectory;  // measured poses only
  core::Trajectory odometry;    // before any correction
  int num_candidates = 0;
  int num_of_known_map = 0;  // beside these: matches are frames of the map that the run started in
  int num_known_places = 0;  // of those, recognized: passed all checks but the evidence
  std::vector<evaluate::AcceptedLoop> loops;
  // Relocalizations, each with the place that was recognized in its view.
  std::vector<evaluate::AcceptedLoop> relocalized;
  std::vector<core::FramePair> matching;  // candidates in which enough features matched
  bool is_scale_free = false;             // monocular: aligned with a scale
  // Odometry by the number of edges that it is composed of; empty if not known, or without a scale.
  std::map<int, std::vector<evaluate::MeasuredMotion>> odometry_chains;
  // Loops of the verifier that the pose graph rejected, at once or later.
  int num_refused_by_graph = 0;
  int num_withdrawn = 0;
};

SlamFindings findings_of(const report::RunRecord& record, bool is_scale_free);

using StampOf = std::map<core::FrameId, double>;  // seconds
// What a ledger says of loops. Throws std::out_of_range for a loop of a frame without a stamp.
void add_loops(const core::Ledger& ledger, const StampOf& stamp_of, SlamFindings& findings);

// Adds the relocalizations of the ledger, of the frames at which tracking was relocalized, with the
// pose of findings.trajectory. Places of another session are left out, as no truth knows them.
// Throws as add_loops() does.
void add_relocalized(const core::Ledger& ledger, const StampOf& stamp_of,
                     const std::set<core::FrameId>& resumed, SlamFindings& findings);

// How good a SLAM run is. Parts without a truth are absent.
struct SlamEvaluation {
  int num_frames = 0;
  int num_measured = 0;
  bool is_scale_free = false;
  std::optional<evaluate::AteResult> ate;
  std::optional<evaluate::AteResult> odometry_ate;
  std::optional<evaluate::DriftAtReturn> drift_at_return;  // not if the scale is free
  double path_m = 0.0;                                     // the true one, while there were poses
  std::optional<evaluate::RpeResult> rpe;                  // over 1 s
  int num_candidates = 0;
  int num_of_known_map = 0;
  int num_known_places = 0;
  evaluate::LoopCheck loops;
  evaluate::LoopCheck relocalized;
  int num_rejoined = 0;  // revisits with a true loop or a correct relocalization
  int num_refused_by_graph = 0;
  int num_withdrawn = 0;
  std::optional<int> num_aliased_matching;  // of the candidates; only if the truth names any
  std::map<int, evaluate::Consistency> drift_model;  // by the number of edges
};

SlamEvaluation evaluate_slam(const SlamFindings& findings, const core::Truth& truth);

// The accepted loops of the ledger that the ground truth contradicts.
std::set<core::CandidateId> false_loops_of(const core::Ledger& ledger,
                                           const SlamEvaluation& evaluation);

// The truth moved into the world of the estimate, to be drawn with it; empty if they cannot be
// aligned.
core::Trajectory aligned_truth(const SlamEvaluation& evaluation, const core::Truth& truth);

// What recognition alone says.
struct RecognitionFindings {
  int num_candidates = 0;
  std::vector<report::ScoredPair> matches;   // the best of each query
  std::vector<report::ScoredPair> accepted;  // of these
  int window_frames = 0;                     // as retrieval used it
};

// How good it is.
struct RecognitionEvaluation {
  int num_candidates = 0;
  int num_accepted = 0;
  std::optional<evaluate::PrecisionRecall> curve;    // of the scores of all matches
  std::optional<evaluate::AcceptedCounts> accepted;  // at the shipped threshold
  std::optional<int> num_aliased;                    // of the accepted; only if the truth names any
};

// A run that was cut short is scored as far as it went: queries that were never asked count as
// missed.
RecognitionEvaluation evaluate_recognition(const RecognitionFindings& findings,
                                           const core::Truth& truth);

// Which describer a run used: its checksum, and "hog" or the name of the network's file.
report::Figure describer_figure(const describe::Config& config, std::uint64_t checksum);

// As shown to a person.
std::vector<report::Figure> figures_of(const SlamEvaluation& evaluation);
std::vector<report::Figure> figures_of(const RecognitionEvaluation& evaluation);

}  // namespace samewhere::run
