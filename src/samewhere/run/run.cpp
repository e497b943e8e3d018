#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/input/newest.hpp>
#include <samewhere/input/prefetch.hpp>
#include <samewhere/report/figure.hpp>
#include <samewhere/report/funnel.hpp>
#include <samewhere/report/jpeg.hpp>
#include <samewhere/run/candidate_matches.hpp>
#include <samewhere/run/frame_feed.hpp>
#include <samewhere/run/map_export.hpp>
#include <samewhere/run/mapped_slam.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/run/position_covariances.hpp>
#include <samewhere/run/prior.hpp>
#include <samewhere/run/recognition.hpp>
#include <samewhere/run/run.hpp>
#include <samewhere/run/run_metrics.hpp>
#include <samewhere/run/run_notes.hpp>
#include <samewhere/run/run_odometry.hpp>

namespace samewhere::run {
namespace {

// Lengths, in edges, over which the drift model is held against the truth.
constexpr int kChains[] = {1, 10};

// Candidates whose matches the report shows.
constexpr std::size_t kMaxMatchedCandidates = 250;
// Keyframes whose covariance the report shows.
constexpr std::size_t kMaxCovariances = 150;

RunOutcome start_outcome(const pipeline::Config& config, const core::SourceInfo& info) {
  RunOutcome outcome;
  outcome.record.title = info.name;
  outcome.record.source = config.source;
  outcome.record.config_yaml = core::config_as_yaml(config);
  return outcome;
}

// Read ahead in a thread of its own: one frame, or in real time the newest.
std::unique_ptr<core::Source> read_ahead(std::unique_ptr<core::Source> source,
                                         const pipeline::Config& config) {
  if (source->info().is_live) return input::newest(std::move(source));
  return config.input.realtime ? input::played(std::move(source))
                               : input::prefetched(std::move(source));
}

void record_frames(const pipeline::Slam& slam, const std::vector<std::string>& names,
                   report::RunRecord& record) {
  const core::Trajectory trajectory = pipeline::trajectory_of(slam.map(), slam.frames());
  std::size_t num_measured = 0;
  for (std::size_t i = 0; i < slam.frames().size(); ++i) {
    report::FrameRecord frame{slam.frames()[i], names[i], std::nullopt};
    if (is_confirmed(frame.pose))
      frame.world_from_camera = trajectory[num_measured++].world_from_camera;
    else if (frame.pose.is_measured)
      frame.world_from_camera = pipeline::world_from_camera(slam.map(), frame.pose);
    record.frames.push_back(std::move(frame));
  }
}

// Thumbnails are kept for every frame that may be asked for, and dropped at the end if it was not.
void drop_unused_thumbnails(report::RunRecord& record) {
  std::map<core::FrameId, std::string> used;
  for (const auto& row : record.ledger) {
    for (const core::FrameId frame : {row.candidate.query, row.candidate.match}) {
      const auto known = record.thumbnails.find(frame);
      if (known != record.thumbnails.end()) used.insert(*known);
    }
  }
  record.thumbnails = std::move(used);
}

// Thumbnails of frames of the loaded map that are in the ledger. Optional: without them the run
// goes on.
void add_known_thumbnails(const std::filesystem::path& map, report::RunRecord& record) try {
  scene::MapFile file = scene::MapFile::open(map);
  for (const core::LedgerRow& row : record.ledger) {
    const core::FrameId match = row.candidate.match;
    if (match.session() == row.candidate.query.session() || record.thumbnails.contains(match))
      continue;
    if (const auto jpeg = file.thumbnail(match)) record.thumbnails[match] = *jpeg;
  }
} catch (const core::InputError& error) {
  spdlog::warn("{}; the report lacks its thumbnails", error.what());
}

void note_first_pose(const pipeline::Slam& slam, report::RunRecord& record) {
  if (!record.first_pose_s && slam.frames().back().is_measured)
    record.first_pose_s = core::seconds_since_program_start();
}

report::Figure relocalizations_figure(const pipeline::Slam& slam) {
  const pipeline::RelocalizationCounts& counts = slam.relocalizations();
  return report::figure(
      "provisional relocalizations", "{}: confirmed {}, taken back {}, open at the end {}",
      counts.num_provisional, counts.num_confirmed, counts.num_taken_back, counts.num_open());
}

// Where poses of the run end as provisional ones: they are no part of the trajectory.
std::optional<std::string> note_on_provisional(const pipeline::Slam& slam,
                                               const std::vector<report::FrameRecord>& frames) {
  const auto num_provisional = std::ranges::count(
      frames, core::FrameStatus::kProvisional, [](const auto& frame) { return frame.pose.status; });
  if (slam.relocalizations().num_open() == 0 || num_provisional == 0) return std::nullopt;
  return fmt::format(
      "the place in the map was not confirmed: {} frames have a provisional pose, in frames.csv "
      "alone; further metres confirm it or take it back, and where no two places look alike, "
      "--prior unique does",
      num_provisional);
}

void record_slam(const pipeline::Slam& slam, const std::vector<std::string>& names,
                 report::RunRecord& record) {
  record_frames(slam, names, record);
  record.ledger = slam.ledger();
  record.points = points_of(slam.map());
  record.odometry = pipeline::odometry_of(slam.map(), slam.frames());
  record.timings.add(slam.timings());
  record.timings.add_processor(report::kWholeFrameStage, slam.processor_ms_beside());
}

// What the report shows beside the results.
void record_for_page(const MappedSlam& mapped, const pipeline::Config& config,
                     report::RunRecord& record) {
  const pipeline::Slam& slam = mapped.slam();
  record.matches = candidate_matches(record.ledger, slam.map(), config, kMaxMatchedCandidates);
  record.limits = score_limits(config.verify);
  if (mapped.is_metric())
    record.covariances = position_covariances(slam.map(), slam.session(), config, kMaxCovariances);
}

// "frames 839 to 853: scale 1/8.1 of the usual", of at most three; the numbers are of all.
report::Figure figure_of(const std::vector<track::ScaleDriftInterval>& intervals) {
  constexpr std::size_t kMost = 3;
  report::Figure figure{"scale drift suspected", "", {}};
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const auto first = static_cast<double>(intervals[i].first.index());
    const auto last = static_cast<double>(intervals[i].last.index());
    const double factor = intervals[i].factor;
    figure.numbers.insert(figure.numbers.end(), {first, last, factor});
    if (i >= kMost) continue;
    const std::string of_usual = factor < 1.0 ? fmt::format("1/{:.1f} of the usual", 1.0 / factor)
                                              : fmt::format("{:.1f} times the usual", factor);
    figure.value +=
        fmt::format("{}frames {} to {}: scale {}", i == 0 ? "" : "; ", first, last, of_usual);
  }
  if (intervals.size() > kMost) figure.value += fmt::format("; {} more", intervals.size() - kMost);
  return figure;
}

// Metrics of the run, and the ground truth for the plot.
void record_figures(const MappedSlam& mapped, const pipeline::Config& config, const MapPlan& plan,
                    const core::Truth& truth, report::RunRecord& record) {
  const pipeline::Slam& slam = mapped.slam();
  SlamFindings findings = findings_of(record, !mapped.is_metric());
  for (const int num_edges : kChains) {
    if (mapped.is_metric())
      findings.odometry_chains[num_edges] =
          pipeline::odometry_chains_of(slam.map(), slam.session(), num_edges);
  }
  const SlamEvaluation evaluation = evaluate_slam(findings, truth);
  record.figures = figures_of(evaluation);
  record.is_scale_unknown = !mapped.is_metric();
  if (record.is_scale_unknown) {
    record.figures.push_back(
        {"scale", "unknown: one camera without depth; lengths of the results are in map units"});
  }
  if (!slam.scale_drift().empty()) {
    record.figures.push_back(figure_of(slam.scale_drift()));
    spdlog::warn("scale drift suspected: {}", record.figures.back().value);
  }
  if (evaluation.num_measured == 0 && plan.known.empty())
    record.figures.push_back({"not initialized, at the end", slam.why_not_initialized()});
  record.figures.push_back(prior_figure(record.ledger, config.verify));
  if (auto relocalization = relocalization_prior_figure(record.ledger, config.verify))
    record.figures.push_back(*std::move(relocalization));
  record.figures.push_back(
      report::figure("re-initializations", "{}", slam.num_reinitializations()));
  record.figures.push_back(relocalizations_figure(slam));
  if (auto note = note_on_provisional(slam, record.frames))
    record.figures.push_back({"note", *std::move(note)});
  record.figures.push_back(report::figure("keyframes / landmarks", "{} / {}",
                                          num_live(slam.map().keyframes),
                                          num_live(slam.map().landmarks)));
  record.figures.push_back(describer_figure(config.describe, slam.describer_checksum()));
  record.truth = aligned_truth(evaluation, truth);
  record.false_loops = false_loops_of(record.ledger, evaluation);
}

void report_coverage(const RunOdometry& odometry, const pipeline::Slam& slam,
                     report::RunRecord& record) {
  record.figures.push_back(odometry.figure());
  if (auto agreement = odometry.figure(slam.odometry_agreement()))
    record.figures.push_back(*std::move(agreement));
  if (!record.input_error) record.input_error = odometry.error();
}

// Frames whose match passes the geometric checks but neither sequence nor prior accepts it; none if
// any loop was accepted.
std::set<core::FrameId> unconfirmed_queries(const core::Ledger& ledger, core::Refusal check) {
  std::set<core::FrameId> unconfirmed;
  for (const core::LedgerRow* row : report::final_rows(ledger)) {
    if (core::is_loop(row->verdict)) return {};
    if (core::stage_of(row->verdict) == core::name_of(check))
      unconfirmed.insert(row->candidate.query);
  }
  return unconfirmed;
}

// A hint for runs with few or no accepted candidates.
std::optional<std::string> note_on(const core::Ledger& ledger, const pipeline::Config& config) {
  if (ledger.empty()) {
    return fmt::format(
        "no frame has a similar one more than {} frames before it "
        "(retrieve.window_frames)",
        config.retrieve.window_frames);
  }
  const std::size_t num_alone = unconfirmed_queries(ledger, core::Refusal::kEvidence).size();
  if (num_alone > 0) {
    return fmt::format(
        "{} frames match an earlier one, and appearance alone accepts nothing; where no two places "
        "look alike, --prior unique does",
        num_alone);
  }
  const std::size_t num_unconfirmed = unconfirmed_queries(ledger, core::Refusal::kSequence).size();
  if (num_unconfirmed == 0) return std::nullopt;
  return fmt::format(
      "{} frames match an earlier one, but no {} consecutive views do; --set verify.min_views=1 "
      "accepts single views",
      num_unconfirmed, config.verify.min_views);
}

void feed_frame(core::Frame& frame, std::optional<RunOdometry>& odometry, MappedSlam& mapped,
                core::Timings& timings) {
  const core::ScopedTimer timer(timings, report::kWholeFrameStage);
  if (odometry) odometry->see(frame);
  mapped.feed(frame);
}

}  // namespace

RunOutcome run_slam(std::unique_ptr<core::Source> unbuffered, const pipeline::Config& given,
                    const MapPlan& plan, bool is_quiet, Watcher* watcher) {
  const auto source = read_ahead(for_slam(std::move(unbuffered), given), given);
  require_slam_input(source->info(), given);
  const core::Truth truth = source->truth();
  pipeline::Config config = with_window_in_frames(given, source->info());
  std::optional<RunOdometry> odometry;
  if (config.odometry.is_used()) {
    odometry.emplace(config, source->info());
    config.odometry = odometry->settings();
  }
  RunOutcome outcome = start_outcome(config, source->info());
  const bool is_monocular = is_scale_free(source->info());
  MappedSlam mapped(config,
                    is_monocular ? pipeline::DepthFrom::kMotion : pipeline::DepthFrom::kSensor,
                    watched(plan, watcher));
  if (odometry) mapped.follow(odometry->path());
  const pipeline::Slam& slam = mapped.slam();
  RunNotes notes(watcher);
  FrameFeed feed(*source, outcome.record, is_quiet);
  if (watcher != nullptr) watcher->begin(source->info(), config, !mapped.is_metric());
  while (std::optional<core::Frame> frame = feed.next()) {
    feed_frame(*frame, odometry, mapped, outcome.record.timings);
    note_first_pose(slam, outcome.record);
    notes.add(*frame, slam);
    feed.note(notes.text());
  }

  outcome.map_error = mapped.finish();
  if (!source->info().is_live && !config.input.realtime)
    outcome.record.processor_ms = core::process_processor_ms();

  report::RunRecord& record = outcome.record;
  record.thumbnails = mapped.take_thumbnails();
  record_slam(slam, notes.names(), record);
  record_for_page(mapped, config, record);
  if (!plan.known.empty()) add_known_thumbnails(plan.known, record);
  record_figures(mapped, config, plan, truth, record);
  if (odometry) report_coverage(*odometry, slam, record);
  feed.report();
  return outcome;
}

RunOutcome run_recognition(std::unique_ptr<core::Source> unbuffered, const pipeline::Config& given,
                           std::function<void()> begin, bool is_quiet, Watcher* watcher) {
  const auto source = read_ahead(std::move(unbuffered), given);
  const core::Truth truth = source->truth();
  const pipeline::Config config = with_window_in_frames(given, source->info());
  RunOutcome outcome = start_outcome(config, source->info());
  Recognition recognition(config, watcher);
  FrameFeed feed(*source, outcome.record, is_quiet);
  const auto run = config.threads ? run_in_threads : run_in_turn;
  const auto next = [&] {
    auto frame = feed.next();
    if (frame && begin) std::exchange(begin, {})();
    return frame;
  };
  if (watcher != nullptr) watcher->begin_recognition(source->info(), config);
  run(next, recognition.steps());
  std::move(recognition).report_to(outcome);
  report::RunRecord& record = outcome.record;
  record.limits = score_limits(config.verify);
  feed.report();
  drop_unused_thumbnails(record);
  const RecognitionFindings findings{static_cast<int>(report::final_rows(record.ledger).size()),
                                     outcome.matches, outcome.accepted,
                                     config.retrieve.window_frames};
  const auto measured = figures_of(evaluate_recognition(findings, truth));
  record.figures.insert(record.figures.begin(), measured.begin(), measured.end());
  record.figures.push_back(prior_figure(record.ledger, config.verify));
  if (auto note = note_on(record.ledger, config))
    record.figures.push_back({"note", *std::move(note)});
  return outcome;
}

}  // namespace samewhere::run
