#include <algorithm>
#include <utility>

#include <samewhere/core/channel.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/stage_thread.hpp>
#include <samewhere/features/orb.hpp>
#include <samewhere/pipeline/verifier_settings.hpp>
#include <samewhere/report/funnel.hpp>
#include <samewhere/report/jpeg.hpp>
#include <samewhere/run/recognition.hpp>
#include <samewhere/run/run_metrics.hpp>

namespace samewhere::run {
namespace {

// The time of all steps of a frame, for each frame that all of them have had.
void add_whole_frames(core::Timings& timings) {
  std::vector<double> whole_ms;
  for (const auto& [step, durations_ms] : timings.durations_ms()) {
    if (whole_ms.empty()) whole_ms.resize(durations_ms.size(), 0.0);
    core::require(whole_ms.size() == durations_ms.size(), "every step has had every frame");
    for (std::size_t i = 0; i < whole_ms.size(); ++i) whole_ms[i] += durations_ms[i];
  }
  double processor_ms = 0.0;
  for (const auto& [step, step_ms] : timings.processor_ms()) processor_ms += step_ms;
  for (const double duration_ms : whole_ms) {
    timings.add(report::kWholeFrameStage, duration_ms,
                processor_ms / static_cast<double>(whole_ms.size()));
  }
}

}  // namespace

pipeline::Config without_map(pipeline::Config config) {
  config.verify.require_pose = false;
  return config;
}

void run_in_turn(const NextFrame& next, const RecognitionSteps& steps) {
  while (const std::optional<core::Frame> frame = next()) {
    steps.verify(steps.search(steps.describe(*frame)));
  }
}

void run_in_threads(const NextFrame& next, const RecognitionSteps& steps) {
  constexpr std::size_t kNumAhead = 4;
  core::Channel<DescribedFrame> described(kNumAhead);
  core::Channel<SearchedFrame> searched(kNumAhead);
  core::SourceThread<DescribedFrame> describing(described, [&]() -> std::optional<DescribedFrame> {
    const std::optional<core::Frame> frame = next();
    if (!frame) return std::nullopt;
    return steps.describe(*frame);
  });
  core::StageThread<DescribedFrame, SearchedFrame> searching(described, searched, steps.search);
  while (const std::optional<SearchedFrame> frame = searched.receive()) steps.verify(*frame);
  describing.join();
  searching.join();
}

Recognition::Recognition(const pipeline::Config& config, Watcher* watcher)
    : config_(without_map(config)),
      detector_(config_, pipeline::recognition_settings(config_)),
      watcher_(watcher) {}

RecognitionSteps Recognition::steps() {
  return {.describe = [this](const core::Frame& frame) { return describe(frame); },
          .search = [this](DescribedFrame frame) { return search(std::move(frame)); },
          .verify = [this](const SearchedFrame& frame) { verify(frame); }};
}

DescribedFrame Recognition::describe(const core::Frame& frame) {
  DescribedFrame described;
  {
    const core::ScopedTimer timer(describe_timings_, "describe");
    described.descriptor = detector_.index().describe(frame.id, frame.images[0]);
  }
  const core::ScopedTimer timer(describe_timings_, "features and thumbnail");
  described.view = features::extract(frame, config_.features);
  described.thumbnail = report::jpeg_bytes(frame.images[0], report::kThumbnailWidth_px);
  if (watcher_ != nullptr) described.frame = frame;
  return described;
}

SearchedFrame Recognition::search(DescribedFrame described) {
  const core::ScopedTimer timer(search_timings_, "search");
  SearchedFrame searched{.found = detector_.index().search(described.descriptor, described.view)};
  searched.described = std::move(described);
  return searched;
}

void Recognition::verify(const SearchedFrame& searched) {
  const DescribedFrame& described = searched.described;
  std::vector<core::Candidate> candidates;
  core::Ledger rows;
  {
    const core::ScopedTimer timer(verify_timings_, "exact similarity");
    candidates = retrieve::compare(described.descriptor, searched.found);
  }
  {
    const core::ScopedTimer timer(verify_timings_, "verify");
    found_.record.thumbnails[described.view.frame] = described.thumbnail;
    rows = detector_.verify(described.descriptor, candidates, described.view, verify::WithoutMap());
    keep(rows);
  }
  if (watcher_ != nullptr) tell_watcher(described, rows);
}

void Recognition::keep(const core::Ledger& rows) {
  core::Ledger& ledger = found_.record.ledger;
  ledger.insert(ledger.end(), rows.begin(), rows.end());
}

void Recognition::tell_watcher(const DescribedFrame& described, const core::Ledger& rows) {
  std::vector<scene::Thumbnail> thumbnails;
  for (const core::LedgerRow& row : rows) {
    for (const core::FrameId frame : {row.candidate.query, row.candidate.match})
      if (told_pictures_.insert(frame).second)
        thumbnails.push_back({frame, found_.record.thumbnails.at(frame)});
  }
  watcher_->see_thumbnails(thumbnails);
  watcher_->see_judged_frame(described.frame, described.view, rows);
}

void Recognition::find_best_of_queries() {
  std::map<core::FrameId, std::vector<core::LedgerRow>> rows_of;
  for (const core::LedgerRow* row : report::final_rows(found_.record.ledger))
    rows_of[row->candidate.query].push_back(*row);
  for (const auto& [query, rows] : rows_of) {
    const core::LedgerRow& best = *verify::best_of_query(rows, config_.verify);
    const double score = verify::score(core::evidence_of(best.verdict), config_.verify);
    found_.matches.push_back({query, best.candidate.match, score});
    if (core::is_loop(best.verdict)) found_.accepted.push_back(found_.matches.back());
  }
}

void Recognition::report_to(RunOutcome& outcome) && {
  keep(detector_.settle_all());
  find_best_of_queries();
  core::Timings timings;
  for (const core::Timings* step : {&describe_timings_, &search_timings_, &verify_timings_}) {
    timings.add(*step);
  }
  add_whole_frames(timings);
  outcome.record.timings.add(timings);
  outcome.record.thumbnails = std::move(found_.record.thumbnails);
  outcome.record.ledger = std::move(found_.record.ledger);
  outcome.matches = std::move(found_.matches);
  outcome.accepted = std::move(found_.accepted);
  outcome.record.figures.push_back(
      describer_figure(config_.describe, detector_.index().describer_checksum()));
}

}  // namespace samewhere::run
