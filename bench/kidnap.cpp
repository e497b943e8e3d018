// kidnap: kidnapped-robot test with a saved map: relocalized correctly, wrongly, or not at all?
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "program.hpp"
#include "walk.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/run/map_saver.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/scene/map_file.hpp>

namespace samewhere::bench {
namespace {

constexpr double kMaxError_m = 0.5;
constexpr double kMaxError_rad = 0.2;

struct Settings {
  std::string preset = "twin-corridors";
  std::string similarity = "1";
  int first_seed = 1000;
  int num_seeds = 1;
  int num_starts = 10;
  int num_frames = 300;  // after each start: about 20 m
  bool is_mid_run = false;
  std::string elsewhere;  // similarity of another building where the camera is; empty: none
  std::string csv_file;
};

// A temporary file of this process; removed at the end.
struct TemporaryFile {
  TemporaryFile() { std::filesystem::remove(path); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }

  std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("samewhere_kidnap_{}.sw", getpid());
};

// The map of the first frames, saved to a file and loaded again, as in a later session.
scene::StoredMap map_of(const Walk& walk, int num_frames, const pipeline::Config& config) {
  pipeline::Slam slam(config);
  for (int i = 0; i < num_frames; ++i) slam.feed(walk.frames[static_cast<std::size_t>(i)]);
  slam.finish();
  const scene::MapHeader header =
      run::map_header(config, *walk.frames.front().rig, slam.describer_checksum());
  const TemporaryFile file;
  scene::MapFile::create(file.path, header)
      .commit(slam.map(), {.frames = slam.frames(), .descriptors = slam.descriptors()});
  scene::MapFile opened = scene::MapFile::open(file.path);
  opened.require_same_settings(header);
  return opened.load();
}

std::string source_of(const Settings& settings, int seed, const std::string& similarity) {
  return fmt::format("twin:{}?seed={}&similarity={}", settings.preset, seed, similarity);
}

// At most `count` of them, evenly spaced.
std::vector<int> evenly_spaced(const std::vector<int>& all, int count) {
  std::vector<int> some;
  for (int i = 0; i < count && !all.empty(); ++i)
    some.push_back(all[static_cast<std::size_t>(i) * all.size() / static_cast<std::size_t>(count)]);
  some.erase(std::unique(some.begin(), some.end()), some.end());
  return some;
}

bool was_seen_before(const core::PlaceTruthMatrix& places, int query, int num_frames) {
  for (int match = 0; match < num_frames; ++match) {
    if (places.at(query, match) != core::PlaceTruth::kDifferent) return true;
  }
  return false;
}

// Frames of which the first `num_frames` show a look-alike place, but not the place itself.
std::vector<int> first_lookalikes(const Walk& walk, int num_frames) {
  std::vector<int> found;
  for (const core::FramePair& pair : walk.truth.aliased_pairs) {
    const bool is_new = found.empty() || found.back() != pair.query;
    if (is_new && pair.match < num_frames && pair.query >= num_frames &&
        !was_seen_before(*walk.truth.places, pair.query, num_frames)) {
      found.push_back(pair.query);
    }
  }
  return found;
}

enum class Answer { kNone, kCorrect, kWrong };

// Of one trial. Metres are those of the truth.
struct Outcome {
  Answer first = Answer::kNone;      // of the first pose, provisional or not
  Answer confirmed = Answer::kNone;  // of the first confirmed pose
  double until_confirmed_m = 0.0;
  int num_taken_back = 0;
  // From the last frame that the look-alike place explains until no wrong pose is given any more.
  std::optional<double> wrong_after_m;
};

struct Outcomes {
  std::vector<Outcome> trials;
  std::vector<double> provisional_ms;  // of each frame
  std::vector<double> tracked_ms;
};

// Whether the error of the pose is below the limits, in the world of a map that began at frame 0.
bool is_correct_pose(const core::Rigid3& world_from_body, const Walk& walk, std::size_t frame) {
  const core::Rigid3 truth = inverse(walk.truth.trajectory[0].world_from_camera) *
                             walk.truth.trajectory[frame].world_from_camera;
  const core::Rigid3 apart = inverse(truth) * world_from_body;
  return apart.translation.norm() < kMaxError_m && core::angle_rad(apart.rotation) < kMaxError_rad;
}

double walked_m(const Walk& walk, int from, int to) {
  const auto position_m = [&](int frame) -> const Eigen::Vector3d& {
    return walk.truth.trajectory[static_cast<std::size_t>(frame)].world_from_camera.translation;
  };
  double sum_m = 0.0;
  for (int i = from; i < to; ++i) sum_m += (position_m(i + 1) - position_m(i)).norm();
  return sum_m;
}

// A trial: the frames of the walk from `start` on, as a session gave their poses at the time.
struct Trial {
  int start = 0;
  std::vector<core::FramePose> poses;
  pipeline::RelocalizationCounts counts;
};

// Walks on until some frames after the relocalization is confirmed, or to the end of the walk.
Trial walk_on(const Walk& walk, int start, const Settings& settings, pipeline::Slam& slam,
              Outcomes& outcomes) {
  constexpr int kTrackedFrames = 15;
  Trial trial{.start = start, .poses = {}, .counts = {}};
  const int end = std::min(start + settings.num_frames, static_cast<int>(walk.frames.size()));
  int num_tracked = 0;
  for (int i = start; i < end && num_tracked < kTrackedFrames; ++i) {
    core::Frame frame = walk.frames[static_cast<std::size_t>(i)];
    frame.id = core::FrameId(slam.frames().size(), slam.session());
    const auto begin = std::chrono::steady_clock::now();
    slam.feed(frame);
    const std::chrono::duration<double, std::milli> spent =
        std::chrono::steady_clock::now() - begin;
    const core::FramePose& pose = slam.frames().back();
    // the first frame with a status was still LOST, or provisional, when it came
    const bool is_second = !trial.poses.empty() && trial.poses.back().status == pose.status;
    trial.poses.push_back(pose);
    if (is_second && pose.status == core::FrameStatus::kProvisional)
      outcomes.provisional_ms.push_back(spent.count());
    if (is_second && pose.status == core::FrameStatus::kTracking)
      outcomes.tracked_ms.push_back(spent.count());
    num_tracked += is_confirmed(pose) ? 1 : 0;
  }
  trial.counts = slam.relocalizations();
  slam.finish();
  return trial;
}

// `common`: by frame, whether it shows what the map holds, or a look-alike of it. Empty: the camera
// is where the map never was, and no pose is correct.
Outcome outcome_of(const Trial& trial, const Walk& walk, const scene::MapVersion& map,
                   const std::vector<bool>& common) {
  Outcome outcome;
  outcome.num_taken_back = trial.counts.num_taken_back;
  int last_common = trial.start;
  bool is_wrong = false;
  for (std::size_t i = 0; i < trial.poses.size(); ++i) {
    const int frame = trial.start + static_cast<int>(i);
    const core::FramePose& pose = trial.poses[i];
    if (common.empty() || common[static_cast<std::size_t>(frame)]) last_common = frame;
    const bool had_been_wrong = std::exchange(is_wrong, false);
    if (pose.is_measured) {
      const bool is_correct = !common.empty() && is_correct_pose(world_from_frame(map, pose), walk,
                                                                 static_cast<std::size_t>(frame));
      is_wrong = !is_correct;
      const Answer answer = is_correct ? Answer::kCorrect : Answer::kWrong;
      if (outcome.first == Answer::kNone) outcome.first = answer;
      if (is_confirmed(pose) && outcome.confirmed == Answer::kNone) {
        outcome.confirmed = answer;
        outcome.until_confirmed_m = walked_m(walk, trial.start, frame);
      }
    }
    if (had_been_wrong && !is_wrong) outcome.wrong_after_m = walked_m(walk, last_common, frame);
  }
  return outcome;
}

// Starts at frame `start`, with the map of an earlier session.
Outcome relocalize(const Walk& walk, int start, const Settings& settings,
                   const scene::StoredMap& map, const std::vector<bool>& common,
                   const pipeline::Config& config, Outcomes& outcomes) {
  pipeline::Slam slam(config, map, pipeline::Slam::Use::kLocalize);
  const Trial trial = walk_on(walk, start, settings, slam, outcomes);
  return outcome_of(trial, walk, map.map, common);
}

// Starts at frame `start`, after the first frames: the session runs on.
Outcome carry_off(const Walk& walk, int num_map_frames, int start, const Settings& settings,
                  const std::vector<bool>& common, const pipeline::Config& config,
                  Outcomes& outcomes) {
  pipeline::Slam slam(config);
  for (int i = 0; i < num_map_frames; ++i) slam.feed(walk.frames[static_cast<std::size_t>(i)]);
  const pipeline::RelocalizationCounts before = slam.relocalizations();
  Trial trial = walk_on(walk, start, settings, slam, outcomes);
  trial.counts.num_taken_back -= before.num_taken_back;
  return outcome_of(trial, walk, slam.map(), common);
}

// Of each frame of the walk: whether one of the first `num_map_frames` shows the same place, or a
// look-alike of it.
std::vector<bool> common_frames(const Walk& walk, int num_map_frames) {
  std::vector<bool> common(walk.frames.size(), false);
  for (const core::FramePair& pair : walk.truth.aliased_pairs)
    if (pair.match < num_map_frames) common[static_cast<std::size_t>(pair.query)] = true;
  for (int i = 0; i < static_cast<int>(walk.frames.size()); ++i)
    if (was_seen_before(*walk.truth.places, i, num_map_frames))
      common[static_cast<std::size_t>(i)] = true;
  return common;
}

Outcomes relocalize_all(const Walk& walk, const std::vector<int>& starts, int num_map_frames,
                        const Settings& settings, const pipeline::Config& config) {
  Outcomes outcomes;
  const std::vector<bool> common = common_frames(walk, num_map_frames);
  std::optional<scene::StoredMap> map;
  if (!settings.is_mid_run) map = map_of(walk, num_map_frames, config);
  core::Progress progress("starts", static_cast<int>(starts.size()));
  for (const int start : starts) {
    outcomes.trials.push_back(
        map ? relocalize(walk, start, settings, *map, common, config, outcomes)
            : carry_off(walk, num_map_frames, start, settings, common, config, outcomes));
    progress.update(static_cast<int>(outcomes.trials.size()));
  }
  progress.finish();
  return outcomes;
}

std::string quantile_of(std::vector<double> values, double quantile, std::string_view format) {
  if (values.empty()) return "-";
  std::sort(values.begin(), values.end());
  const auto index = static_cast<std::size_t>(quantile * static_cast<double>(values.size() - 1));
  return fmt::format(fmt::runtime(format), values[index]);
}

// Time of a provisional frame over that of a tracked frame.
std::string time_ratio(const Outcomes& outcomes, double quantile) {
  const std::string provisional = quantile_of(outcomes.provisional_ms, quantile, "{}");
  const std::string tracked = quantile_of(outcomes.tracked_ms, quantile, "{}");
  if (provisional == "-" || tracked == "-") return "-";
  return fmt::format("{:.2f}", std::stod(provisional) / std::stod(tracked));
}

std::vector<std::string> row_of(const std::string& source, std::string_view where,
                                const Outcomes& outcomes) {
  const std::vector<Outcome>& trials = outcomes.trials;
  const auto count = [&trials](auto Outcome::*member, Answer answer) {
    return fmt::format("{}", std::count_if(trials.begin(), trials.end(),
                                           [&](const Outcome& o) { return o.*member == answer; }));
  };
  int num_taken_back = 0;
  std::vector<double> until_m;
  std::vector<double> wrong_m;
  for (const Outcome& outcome : trials) {
    num_taken_back += outcome.num_taken_back;
    if (outcome.confirmed != Answer::kNone) until_m.push_back(outcome.until_confirmed_m);
    if (outcome.wrong_after_m) wrong_m.push_back(*outcome.wrong_after_m);
  }
  return {source,
          std::string(where),
          fmt::format("{}", trials.size()),
          count(&Outcome::first, Answer::kCorrect),
          count(&Outcome::first, Answer::kWrong),
          count(&Outcome::confirmed, Answer::kCorrect),
          count(&Outcome::confirmed, Answer::kWrong),
          count(&Outcome::confirmed, Answer::kNone),
          fmt::format("{}", num_taken_back),
          quantile_of(until_m, 0.5, "{:.1f}"),
          quantile_of(wrong_m, 1.0, "{:.1f}"),
          time_ratio(outcomes, 0.5),
          time_ratio(outcomes, 0.99)};
}

// The map holds a place and its look-alike. The camera is in another building of the same design:
// at the same similarity it resembles the place as much as the look-alike does, at a larger one
// more.
Outcomes relocalize_elsewhere(const Walk& walk, const std::string& other,
                              const std::vector<int>& starts, int num_map_frames,
                              const Settings& settings, pipeline::Config config) {
  const scene::StoredMap map = map_of(walk, num_map_frames, config);
  config.source = other;
  const Walk elsewhere = walk_of(config);
  Outcomes outcomes;
  core::Progress progress("starts", static_cast<int>(starts.size()));
  for (const int start : starts) {
    outcomes.trials.push_back(relocalize(elsewhere, start, settings, map, {}, config, outcomes));
    progress.update(static_cast<int>(outcomes.trials.size()));
  }
  progress.finish();
  return outcomes;
}

void measure_walk(int seed, const Settings& settings, Table& table) {
  const std::string source = source_of(settings, seed, settings.similarity);
  pipeline::Config config = pipeline::profile("default");
  config.source = source;
  const Walk walk = walk_of(config);
  config = run::with_window_in_frames(config, walk.info);
  const auto& revisits = walk.truth.revisits;
  if (!revisits || revisits->empty() || !walk.truth.places)
    throw core::InputError(source + ": returns to no place, expected a sequence that does");
  const core::FrameSpan revisit = revisits->front();
  std::vector<int> revisit_frames;
  constexpr double kWalk_m = 2.0;  // that is left at least
  const int last_frame = static_cast<int>(walk.frames.size()) - 1;
  for (int i = revisit.first; i <= revisit.last; ++i)
    if (walked_m(walk, i, last_frame) >= kWalk_m) revisit_frames.push_back(i);
  const std::vector<int> starts = evenly_spaced(revisit_frames, settings.num_starts);
  if (!settings.elsewhere.empty()) {
    const std::string other = source_of(settings, seed, settings.elsewhere) + "&copy=1";
    table.rows.push_back(
        row_of(source, "two look-alikes, of " + settings.elsewhere,
               relocalize_elsewhere(walk, other, starts, revisit.first, settings, config)));
    return;
  }
  table.rows.push_back(
      row_of(source, "the place", relocalize_all(walk, starts, revisit.first, settings, config)));
  const int half = revisit.first / 2;
  const auto lookalikes = evenly_spaced(first_lookalikes(walk, half), settings.num_starts);
  if (lookalikes.empty()) return;
  table.rows.push_back(row_of(source, "only its look-alike",
                              relocalize_all(walk, lookalikes, half, settings, config)));
}

void measure(const Settings& settings) {
  Table table{{"walk", "content of the map", "trials", "first pose correct", "first pose wrong",
               "confirmed correct", "confirmed wrong", "never confirmed", "taken back",
               "m until confirmed, median", "m wrong after leaving the common part, most",
               "time of a provisional over a tracked frame, p50", "p99"},
              {}};
  for (int i = 0; i < settings.num_seeds; ++i) {
    measure_walk(settings.first_seed + i, settings, table);
  }
  publish(table, settings.csv_file);
}

std::function<void()> set_up(CLI::App& app) {
  const auto settings = std::make_shared<Settings>();
  app.name("kidnap");
  app.description(
      "Kidnapped-robot test. The map of a sequence up to its first revisit is saved and loaded; "
      "trials start at frames of the revisit. With the map of the first half, they start at frames "
      "of which the map holds only a look-alike place.");
  app.add_option("--preset", settings->preset, "of the built-in world");
  app.add_option("--similarity", settings->similarity, "of places of one kind, 0 to 1");
  app.add_option("--seed", settings->first_seed, "of the first sequence");
  app.add_option("--seeds", settings->num_seeds, "sequences")->check(CLI::Range(1, 100));
  app.add_option("--starts", settings->num_starts, "trials of each sequence and map")
      ->check(CLI::Range(1, 1000));
  app.add_option("--frames", settings->num_frames, "of a trial at most; the default is about 20 m")
      ->check(CLI::Range(1, 100000));
  CLI::Option* elsewhere = app.add_option(
      "--elsewhere", settings->elsewhere,
      "the camera is in another building of the same design with this similarity: no "
      "pose is right");
  app.add_flag("--mid-run", settings->is_mid_run,
               "carried off in the middle of a run: the session that makes the map runs on")
      ->excludes(elsewhere);
  app.add_option("--csv", settings->csv_file, "write the table to this file, too");
  return [settings] { measure(*settings); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
