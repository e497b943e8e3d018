#include <algorithm>
#include <map>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>
#include <samewhere/paper/slam_rows.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/run/run.hpp>
#include <samewhere/run/run_metrics.hpp>

namespace samewhere::paper {
namespace {

using Point = std::array<double, 3>;

Point point_of(const Eigen::Vector3d& at) { return {at.x(), at.y(), at.z()}; }

// At most so many points of a path are drawn.
constexpr std::size_t kMaxPathPoints = 1500;

std::vector<PathPoint> path_of(const core::Trajectory& trajectory, const core::Truth& truth,
                               const core::Sim3& truth_from_estimate) {
  const std::size_t step = trajectory.size() / kMaxPathPoints + 1;
  std::vector<PathPoint> path;
  for (std::size_t i = 0; i < trajectory.size(); i += step) {
    const auto true_pose = evaluate::truth_at(truth.trajectory, trajectory[i].stamp_s);
    if (!true_pose) continue;
    path.push_back({point_of(truth_from_estimate * trajectory[i].world_from_camera.translation),
                    point_of(true_pose->translation)});
  }
  return path;
}

std::vector<PathLoop> loops_of(const evaluate::LoopCheck& check, const core::Truth& truth) {
  std::vector<PathLoop> loops;
  for (const evaluate::CheckedLoop& checked : check.loops) {
    const auto query = evaluate::truth_at(truth.trajectory, checked.loop.query_stamp_s);
    const auto match = evaluate::truth_at(truth.trajectory, checked.loop.match_stamp_s);
    if (!query || !match) continue;
    loops.push_back({point_of(query->translation), point_of(match->translation),
                     checked.truth == evaluate::LoopTruth::kFalse});
  }
  return loops;
}

double frames_per_second(const core::Timings& timings) {
  const auto whole = timings.durations_ms().find(report::kWholeFrameStage);
  if (whole == timings.durations_ms().end()) return 0.0;
  const core::TimingSummary summary = core::summarize(whole->second);
  return summary.total_ms > 0.0 ? 1000.0 * summary.count / summary.total_ms : 0.0;
}

SlamRow row_of(const run::SlamFindings& findings, const core::Truth& truth) {
  const run::SlamEvaluation evaluation = run::evaluate_slam(findings, truth);
  SlamRow row;
  row.num_frames = evaluation.num_frames;
  row.num_measured = evaluation.num_measured;
  row.is_scale_free = evaluation.is_scale_free;
  row.loops_true = evaluation.loops.num_true;
  row.loops_false = evaluation.loops.num_false;
  row.loops_unknown = evaluation.loops.num_unknown;
  if (!evaluation.ate) return row;
  const evaluate::AteResult& ate = *evaluation.ate;
  row.ate_m = {ate.max_m, ate.min_m, ate.median_m, ate.rmse_m};
  row.path = path_of(findings.trajectory, truth, ate.truth_from_estimate);
  row.loops = loops_of(evaluation.loops, truth);
  return row;
}

}  // namespace

const std::vector<ComparedMethod>& slam_configurations() {
  static const std::vector<ComparedMethod> configurations = {
      {"off", "off", "profile default without loop closing"},
      {"paper", "published method", "profile paper"},
      {"usual", "bag of words", "profile usual: bag of words, 12 inliers, no odometry gate"},
      {"default", "samewhere", "profile default"}};
  return configurations;
}

pipeline::Config slam_config(const pipeline::Config& base, const std::string& configuration,
                             int seed) {
  const bool is_off = configuration == "off";
  pipeline::Config config = pipeline::profile(is_off ? "default" : configuration);
  config.source = base.source;
  config.seed = seed;
  if (is_off) config.close_loops = false;
  return config;
}

std::optional<std::string> why_no_slam(const pipeline::Config& config) {
  const auto source = run::open_source(config);
  if (!source->info().is_calibrated) return "no calibration";
  if (source->true_trajectory().empty()) return "no true trajectory";
  return std::nullopt;
}

std::optional<SlamRow> run_slam_once(const pipeline::Config& given, const std::string& name,
                                     const std::string& configuration) {
  auto source = run::open_source_with_truth(given);
  const core::Truth truth = source->truth();
  const core::SourceInfo info = source->info();
  const pipeline::Config config = run::with_window_in_frames(given, info);
  const run::RunOutcome outcome = run::run_slam(std::move(source), config, {}, /*is_quiet=*/true);
  if (outcome.record.is_interrupted) return std::nullopt;
  if (outcome.record.input_error) throw core::InputError(*outcome.record.input_error);
  SlamRow row = row_of(run::findings_of(outcome.record, run::is_scale_free(info)), truth);
  row.recording = name;
  row.configuration = configuration;
  row.seed = given.seed;
  row.frames_per_second = frames_per_second(outcome.record.timings);
  return row;
}

}  // namespace samewhere::paper
