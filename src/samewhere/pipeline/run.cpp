#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/features/orb.hpp>
#include <samewhere/input/prefetch.hpp>
#include <samewhere/pipeline/figures.hpp>
#include <samewhere/pipeline/loop_detector.hpp>
#include <samewhere/pipeline/open_source.hpp>
#include <samewhere/pipeline/run.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/report/jpeg.hpp>

namespace samewhere::pipeline {
namespace {

constexpr int kThumbnailWidth_px = 160;
constexpr double kLongestWindow_frames = 1e9;

// The window in frames, if it was given in seconds.
Config resolved(Config config, const core::SourceInfo& info) {
  auto& retrieve = config.retrieve;
  if (retrieve.window_frames < 0) {
    retrieve.window_frames = static_cast<int>(
        std::lround(std::min(retrieve.window_s * info.frame_rate_hz, kLongestWindow_frames)));
  }
  return config;
}

RunOutcome start_outcome(const Config& config, const core::SourceInfo& info) {
  RunOutcome outcome;
  outcome.record.title = info.name;
  outcome.record.source = config.source;
  outcome.record.config_yaml = core::config_as_yaml(config);
  return outcome;
}

// Feeds every frame to `take` until the source ends, breaks, or somebody presses Ctrl-C.
void for_each_frame(core::Source& source, const char* what, core::Timings& timings,
                    RunOutcome& outcome, const std::function<void(const core::Frame&)>& take) {
  core::Progress progress(what, source.info().num_frames);
  int num_done = 0;
  while (!(outcome.record.is_interrupted = core::is_interrupted())) {
    std::optional<core::Frame> frame;
    try {
      const core::ScopedTimer timer(timings, "wait for input");
      frame = source.next();
    } catch (const core::InputError& error) {
      outcome.record.input_error = error.what();
      return;
    }
    if (!frame) return;
    {
      const core::ScopedTimer timer(timings, report::kWholeFrameStage);
      take(*frame);
    }
    progress.update(++num_done);
  }
}

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
  const Config config = resolved(given, source->info());
  RunOutcome outcome = start_outcome(config, source->info());
  Slam slam(config);
  std::vector<std::string> names;
  for_each_frame(*source, "frames", slam.timings(), outcome, [&](const core::Frame& frame) {
    slam.feed(frame);
    names.push_back(frame.name);
    if (slam.is_keyframe(frame.id)) {
      outcome.record.thumbnails[frame.id] = report::jpeg_bytes(frame.images[0], kThumbnailWidth_px);
    }
  });

  report::RunRecord& record = outcome.record;
  record_frames(slam, names, record);
  record.ledger = slam.ledger();
  record.points = points_of(slam.map());
  record.odometry = odometry_of(slam.map(), slam.frames());
  record.timings = slam.timings();
  drop_unused_thumbnails(record);
  const SlamEvaluation evaluation = evaluate_slam(findings_of(record), truth);
  record.figures = figures_of(evaluation);
  record.figures.push_back(
      {"keyframes / landmarks",
       fmt::format("{} / {}", slam.map().keyframes.size(), slam.map().landmarks.size())});
  record.truth = aligned_truth(evaluation, truth);
  return outcome;
}

RunOutcome run_recognition(std::unique_ptr<core::Source> unbuffered, const Config& given) {
  const auto source = input::prefetched(std::move(unbuffered));
  const core::Truth truth = source->truth();
  const Config config = resolved(given, source->info());
  RunOutcome outcome = start_outcome(config, source->info());
  report::RunRecord& record = outcome.record;
  LoopDetector detector(config, record.timings);
  const auto without_odometry = [](const core::Candidate&, const core::Sim3&) {
    return std::nullopt;
  };
  for_each_frame(*source, "frames", record.timings, outcome, [&](const core::Frame& frame) {
    const features::View view = features::extract(frame, config.features);
    const auto rows = detector.look(frame.images[0], view, without_odometry);
    record.thumbnails[frame.id] = report::jpeg_bytes(frame.images[0], kThumbnailWidth_px);
    record.ledger.insert(record.ledger.end(), rows.begin(), rows.end());
    const core::LedgerRow* best = best_of_query(rows, config.verify);
    if (best == nullptr) return;
    const double score = verify::score(core::evidence_of(best->verdict), config.verify);
    outcome.matches.push_back({best->candidate.query, best->candidate.match, score});
    if (core::is_loop(best->verdict)) outcome.accepted.push_back(outcome.matches.back());
  });
  drop_unused_thumbnails(record);
  const RecognitionFindings findings{static_cast<int>(record.ledger.size()), outcome.matches,
                                     outcome.accepted, config.retrieve.window_frames};
  record.figures = figures_of(evaluate_recognition(findings, truth));
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
