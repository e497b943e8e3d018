#include <optional>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/input/prefetch.hpp>
#include <samewhere/pipeline/figures.hpp>
#include <samewhere/pipeline/open_source.hpp>
#include <samewhere/pipeline/recognition.hpp>
#include <samewhere/pipeline/run.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/report/jpeg.hpp>

namespace samewhere::pipeline {
namespace {

constexpr int kThumbnailWidth_px = 160;

RunOutcome start_outcome(const Config& config, const core::SourceInfo& info) {
  RunOutcome outcome;
  outcome.record.title = info.name;
  outcome.record.source = config.source;
  outcome.record.config_yaml = core::config_as_yaml(config);
  return outcome;
}

// The frames of a source until it ends, breaks, or somebody presses Ctrl-C, with a progress line on
// stderr. What ended them is in the outcome's record.
class FrameFeed {
 public:
  // `source` and `outcome` outlive the feed.
  FrameFeed(core::Source& source, RunOutcome& outcome)
      : source_(source), outcome_(outcome), progress_("frames", source.info().num_frames) {}

  std::optional<core::Frame> next() {
    if (num_given_ > 0) progress_.update(num_given_);
    outcome_.record.is_interrupted = core::is_interrupted();
    if (outcome_.record.is_interrupted) return std::nullopt;
    try {
      const core::ScopedTimer timer(timings_, "wait for input");
      ++num_given_;
      return source_.next();
    } catch (const core::InputError& error) {
      outcome_.record.input_error = error.what();
      return std::nullopt;
    }
  }

  const core::Timings& timings() const { return timings_; }

 private:
  core::Source& source_;
  RunOutcome& outcome_;
  core::Timings timings_;
  core::Progress progress_;
  int num_given_ = 0;
};

std::vector<report::ColouredPoint> points_of(const scene::MapVersion& map) {
  std::vector<report::ColouredPoint> points;
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    const scene::Landmark& landmark = map.landmarks[i];
    points.push_back({position_in_world(map, landmark).cast<float>(), landmark.rgb});
  }
  return points;
}

void record_frames(const Slam& slam, const std::vector<std::string>& names,
                   report::RunRecord& record) {
  const core::Trajectory trajectory = trajectory_of(slam.map(), slam.frames());
  std::size_t num_measured = 0;
  for (std::size_t i = 0; i < slam.frames().size(); ++i) {
    report::FrameRecord frame{slam.frames()[i], names[i], std::nullopt};
    if (frame.pose.is_measured)
      frame.world_from_camera = trajectory[num_measured++].world_from_camera;
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

}  // namespace

RunOutcome run_slam(std::unique_ptr<core::Source> unbuffered, const Config& given) {
  const auto source = input::prefetched(std::move(unbuffered));
  require_slam_input(source->info(), given);
  const core::Truth truth = source->truth();
  const Config config = with_window_in_frames(given, source->info());
  RunOutcome outcome = start_outcome(config, source->info());
  Slam slam(config);
  std::vector<std::string> names;
  FrameFeed feed(*source, outcome);
  while (const std::optional<core::Frame> frame = feed.next()) {
    const core::ScopedTimer timer(slam.timings(), report::kWholeFrameStage);
    slam.feed(*frame);
    names.push_back(frame->name);
    if (slam.is_keyframe(frame->id)) {
      outcome.record.thumbnails[frame->id] =
          report::jpeg_bytes(frame->images[0], kThumbnailWidth_px);
    }
  }

  report::RunRecord& record = outcome.record;
  record_frames(slam, names, record);
  record.ledger = slam.ledger();
  record.points = points_of(slam.map());
  record.odometry = odometry_of(slam.map(), slam.frames());
  record.timings = slam.timings();
  record.timings.add(feed.timings());
  drop_unused_thumbnails(record);
  const SlamEvaluation evaluation = evaluate_slam(findings_of(record), truth);
  record.figures = figures_of(evaluation);
  record.figures.push_back(
      {"keyframes / landmarks",
       fmt::format("{} / {}", slam.map().keyframes.size(), slam.map().landmarks.size())});
  record.figures.push_back(describer_figure(config.describe, slam.describer_checksum()));
  record.truth = aligned_truth(evaluation, truth);
  return outcome;
}

RunOutcome run_recognition(std::unique_ptr<core::Source> unbuffered, const Config& given) {
  const auto source = input::prefetched(std::move(unbuffered));
  const core::Truth truth = source->truth();
  const Config config = with_window_in_frames(given, source->info());
  RunOutcome outcome = start_outcome(config, source->info());
  Recognition recognition(config);
  FrameFeed feed(*source, outcome);
  const auto run = config.threads ? run_in_threads : run_in_turn;
  run([&feed] { return feed.next(); }, recognition.steps());
  std::move(recognition).report_to(outcome);
  report::RunRecord& record = outcome.record;
  record.timings.add(feed.timings());
  drop_unused_thumbnails(record);
  const RecognitionFindings findings{static_cast<int>(record.ledger.size()), outcome.matches,
                                     outcome.accepted, config.retrieve.window_frames};
  const auto measured = figures_of(evaluate_recognition(findings, truth));
  record.figures.insert(record.figures.begin(), measured.begin(), measured.end());
  if (record.ledger.empty()) {
    record.figures.push_back(
        {"note",
         fmt::format("no frame is more than {} frames older than another that looks like it "
                     "(retrieve.window_frames)",
                     config.retrieve.window_frames)});
  }
  return outcome;
}

}  // namespace samewhere::pipeline
