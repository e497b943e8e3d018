// What the library's live interface costs: track() frame by frame, with and without a consumer that
// reads a snapshot for every frame, waiting for late stages and never; and a snapshot of large
// maps.
//   live RECORDING [key=value]...          live --snapshots
// And whether it gives the bits of `samewhere run`, and LoopCloser the verdicts of a run with an
// odometry file, which has a row for each frame:
//   live --equal RECORDING [key=value]...  live --closer RECORDING ODOMETRY SENSOR
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <samewhere/core/program.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/input/odometry_file.hpp>
#include <samewhere/library/convert.hpp>
#include <samewhere/library/map_content.hpp>
#include <samewhere/loop_closer.hpp>
#include <samewhere/recording.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/run/run.hpp>
#include <samewhere/slam.hpp>

namespace samewhere::bench {
namespace {

using Clock = std::chrono::steady_clock;

double since_ms(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct Consumer {
  bool reads_snapshots = false;
  bool never_waits = false;
  double period_s = 0.0;  // of a camera; 0: the next frame comes at once
};

// As a camera would: a frame comes when it is due, or when the one before is done.
void track(const std::string& source, const std::vector<std::string>& settings,
           const Consumer& consumer) {
  Recording recording(source, settings);
  Slam slam(recording.calibration(), {.settings = settings, .never_wait = consumer.never_waits});
  std::vector<double> track_ms;
  std::vector<double> snapshot_ms;
  std::size_t num_points = 0;
  int num_lost = 0;
  double largest_step_m = 0.0;
  double largest_map_step_m = 0.0;
  Tracked before;
  Clock::time_point due = Clock::now();
  while (const auto frame = recording.next()) {
    const std::chrono::duration<double> period(consumer.period_s);
    due = std::max(due + std::chrono::duration_cast<Clock::duration>(period), Clock::now());
    while (Clock::now() < due) {
    }
    auto start = Clock::now();
    const Tracked tracked = slam.track(*frame);
    track_ms.push_back(since_ms(start));
    num_lost += tracked.has_pose() ? 0 : 1;
    if (tracked.has_pose() && before.has_pose()) {
      const Pose step = before.odom_from_camera.inverse() * tracked.odom_from_camera;
      const Pose map_step = before.map_from_camera().inverse() * tracked.map_from_camera();
      largest_step_m = std::max(largest_step_m, step.translation().norm());
      largest_map_step_m = std::max(largest_map_step_m, map_step.translation().norm());
    }
    before = tracked;
    if (!consumer.reads_snapshots) continue;
    start = Clock::now();
    const auto map = slam.map();
    num_points += map->keyframes().size() + map->landmarks().size();
    snapshot_ms.push_back(since_ms(start));
  }
  slam.finish();
  const core::TimingSummary times = core::summarize(track_ms);
  core::print(
      "{} {}: track() median {:.2f} p99 {:.2f} max {:.2f} ms, {} frames, {} without pose, {} "
      "loops, "
      "largest step of odom {:.3f} m, of map {:.3f} m",
      consumer.never_waits ? "never_wait" : "waits",
      consumer.period_s > 0.0 ? "at the camera's rate" : "at once", times.median_ms, times.p99_ms,
      *std::max_element(track_ms.begin(), track_ms.end()), track_ms.size(), num_lost,
      slam.map()->loops().size(), largest_step_m, largest_map_step_m);
  if (consumer.reads_snapshots) {
    core::print("; snapshot read for every frame: median {:.2f} ms of {} points in all",
                core::summarize(snapshot_ms).median_ms, num_points);
  }
  core::print("\n");
}

// A map of so many keyframes, each with landmarks of its own.
scene::MapVersion map_of(std::size_t num_keyframes) {
  constexpr std::size_t kLandmarks = 60;
  scene::MapVersion map;
  auto rig = std::make_shared<core::Rig>();
  rig->cameras.emplace_back(core::PinholeRadtan{});
  rig->body_from_camera.emplace_back();
  for (std::size_t i = 0; i < num_keyframes; ++i) {
    scene::Keyframe keyframe{.id = core::KeyframeId(i)};
    keyframe.view.frame = core::FrameId(10 * i);
    keyframe.view.rig = rig;
    keyframe.slots.resize(kLandmarks);
    scene::Edit edit{.keyframes = {keyframe}};
    for (std::size_t k = 0; k < kLandmarks; ++k) {
      scene::Landmark landmark{.id = core::LandmarkId(map.landmarks.size() + k),
                               .anchor = keyframe.id};
      landmark.observations.push_back({keyframe.id, static_cast<int>(k)});
      edit.landmarks.push_back(landmark);
    }
    map = scene::apply(std::move(map), edit);
  }
  return map;
}

void measure_snapshots() {
  constexpr int kRepeats = 50;
  for (const std::size_t num_keyframes : {100, 1000, 4000}) {
    const scene::MapVersion map = map_of(num_keyframes);
    std::vector<double> take_ms;
    std::vector<double> read_ms;
    for (int i = 0; i < kRepeats; ++i) {
      auto start = Clock::now();
      const auto taken = library::snapshot(map, true);
      take_ms.push_back(since_ms(start));
      start = Clock::now();
      const std::size_t num_read = taken->keyframes().size() + taken->landmarks().size();
      if (num_read > 0) read_ms.push_back(since_ms(start));
    }
    core::print(
        "{} keyframes, {} landmarks: taken in {:.3f} ms, all poses and landmarks in {:.2f} ms\n",
        num_keyframes, map.landmarks.size(), core::summarize(take_ms).median_ms,
        core::summarize(read_ms).median_ms);
  }
}

using Verdicts = std::map<std::uint64_t, std::string>;

void add(Verdicts& verdicts, const LoopVerdict& verdict) {
  verdicts[verdict.candidate] = fmt::format("{} {} {} {}", verdict.query.index, verdict.match.index,
                                            static_cast<int>(verdict.decision), verdict.check);
}

Verdicts verdicts_of(const core::Ledger& ledger) {
  Verdicts verdicts;
  for (const core::LedgerRow& row : ledger) add(verdicts, library::verdict_of(row));
  return verdicts;
}

std::size_t num_accepted(const core::Ledger& ledger) {
  std::set<std::uint64_t> accepted;
  for (const core::LedgerRow& row : ledger) {
    const LoopVerdict verdict = library::verdict_of(row);
    if (verdict.decision == LoopDecision::kAccepted) {
      accepted.insert(verdict.candidate);
    } else {
      accepted.erase(verdict.candidate);  // a later row of the same: withdrawn
    }
  }
  return accepted.size();
}

// Prints the first that differ.
std::size_t num_different(const Verdicts& live, const Verdicts& of_run) {
  std::set<std::uint64_t> candidates;
  for (const auto& [candidate, text] : live) candidates.insert(candidate);
  for (const auto& [candidate, text] : of_run) candidates.insert(candidate);
  std::size_t count = 0;
  for (const std::uint64_t candidate : candidates) {
    const auto a = live.find(candidate);
    const auto b = of_run.find(candidate);
    const std::string of_a = a == live.end() ? "none" : a->second;
    const std::string of_b = b == of_run.end() ? "none" : b->second;
    if (of_a == of_b) continue;
    constexpr std::size_t kMostPrinted = 5;
    if (++count <= kMostPrinted)
      core::print("  candidate {}: live {}, run {}\n", candidate, of_a, of_b);
  }
  return count;
}

void compare_with_run(const std::string& source, const std::vector<std::string>& settings) {
  pipeline::Config config = library::config_of("default", settings, std::nullopt);
  config.source = source;
  const run::RunOutcome run = run::run_slam(run::open_source(config), config, {}, true);
  for (const bool threads : {true, false}) {
    Recording recording(source, settings);
    Slam slam(recording.calibration(), {.settings = settings, .threads = threads});
    Verdicts verdicts;
    const auto take = [&] {
      for (const Event& event : slam.take_events())
        if (const auto* verdict = std::get_if<LoopVerdict>(&event.what)) add(verdicts, *verdict);
    };
    std::vector<Tracked> tracked;
    while (const auto frame = recording.next()) {
      tracked.push_back(slam.track(*frame));
      take();
    }
    slam.finish();
    take();
    const auto trajectory = slam.trajectory();
    std::size_t num_poses = 0;
    std::size_t num_equal = 0;
    for (const report::FrameRecord& frame : run.record.frames) {
      if (!is_confirmed(frame.pose)) continue;
      const Pose expected = library::pose_of(*frame.world_from_camera);
      num_equal += num_poses < trajectory.size() &&
                   trajectory[num_poses].map_from_camera.matrix() == expected.matrix();
      ++num_poses;
    }
    core::print(
        "{} threads {}: {} poses of run, {} of live, {} equal to the bit; {} verdicts, {} "
        "different\n",
        source, threads, num_poses, trajectory.size(), num_equal, verdicts.size(),
        num_different(verdicts, verdicts_of(run.record.ledger)));
  }
}

void compare_closer(const std::string& source, const std::string& odometry,
                    const std::string& sensor) {
  const std::vector<std::string> settings = {"odometry.file=" + odometry,
                                             "odometry.sensor=" + sensor};
  pipeline::Config config = library::config_of("default", settings, std::nullopt);
  config.source = source;
  const run::RunOutcome run = run::run_slam(run::open_source(config), config, {}, true);
  const auto kind = static_cast<OdometrySensor>(config.odometry.sensor);
  Recording recording(source);
  LoopCloser closer(recording.calibration(), {.sensor = kind, .are_keyframes = false});
  Verdicts verdicts;
  for (const input::OdometryRow& row : input::read_odometry(odometry)) {
    const auto frame = recording.next();
    if (!frame) break;
    for (const LoopVerdict& verdict :
         closer.add({*frame, library::pose_of(row.world_from_body), row.covariance}))
      add(verdicts, verdict);
  }
  for (const LoopVerdict& verdict : closer.finish()) add(verdicts, verdict);
  const std::size_t num_changed = num_different(verdicts, verdicts_of(run.record.ledger));
  core::print("{} {}: {} verdicts, {} different; loops: {} of LoopCloser, {} of run\n", source,
              sensor, verdicts.size(), num_changed, closer.map()->loops().size(),
              num_accepted(run.record.ledger));
}

int measure(const std::vector<std::string>& arguments) {
  if (arguments.empty() || arguments[0] == "--snapshots") {
    measure_snapshots();
    return core::kDone;
  }
  if (arguments[0] == "--equal" && arguments.size() > 1) {
    compare_with_run(arguments[1], {arguments.begin() + 2, arguments.end()});
    return core::kDone;
  }
  if (arguments[0] == "--closer" && arguments.size() > 3) {
    compare_closer(arguments[1], arguments[2], arguments[3]);
    return core::kDone;
  }
  const std::vector<std::string> settings(arguments.begin() + 1, arguments.end());
  constexpr double kCamera_s = 1.0 / 15.0;
  for (const bool reads_snapshots : {false, true})
    track(arguments[0], settings, {.reads_snapshots = reads_snapshots});
  for (const bool never_waits : {false, true})
    track(arguments[0], settings, {.never_waits = never_waits, .period_s = kCamera_s});
  return core::kDone;
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::core::run_program("live", [&] {
    return samewhere::bench::measure({argv + 1, argv + argc});
  });
}
