// kidnap: kidnapped-robot test with a saved map: relocalized correctly, wrongly, or not at all?
#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
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
  int num_frames = 30;  // after each start
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

struct Outcomes {
  int num_correct = 0;
  int num_wrong = 0;
  int num_undecided = 0;          // no pose
  std::vector<int> frames_taken;  // until relocalized
};

// Whether the error of the pose is below the limits, in the world of a map that began at frame 0.
bool is_correct_pose(const core::Rigid3& world_from_body, const Walk& walk, std::size_t frame) {
  const core::Rigid3 truth = inverse(walk.truth.trajectory[0].world_from_camera) *
                             walk.truth.trajectory[frame].world_from_camera;
  const core::Rigid3 apart = inverse(truth) * world_from_body;
  return apart.translation.norm() < kMaxError_m && core::angle_rad(apart.rotation) < kMaxError_rad;
}

// Starts at frame `start` and runs for at most `num_frames`; the first pose counts.
void relocalize(const Walk& walk, int start, int num_frames, const scene::StoredMap& map,
                const pipeline::Config& config, Outcomes& outcomes) {
  pipeline::Slam slam(config, map, pipeline::Slam::Use::kLocalize);
  const int end = std::min(start + num_frames, static_cast<int>(walk.frames.size()));
  for (int i = start; i < end; ++i) {
    core::Frame frame = walk.frames[static_cast<std::size_t>(i)];
    frame.id = core::FrameId(static_cast<std::uint64_t>(i - start), slam.session());
    slam.feed(frame);
    const core::FramePose& pose = slam.frames().back();
    if (!pose.is_measured) continue;
    const core::Rigid3 world_from_frame =
        world_from_body(map.map, pose.reference_keyframe) * pose.reference_from_frame;
    const bool is_correct = is_correct_pose(world_from_frame, walk, static_cast<std::size_t>(i));
    ++(is_correct ? outcomes.num_correct : outcomes.num_wrong);
    outcomes.frames_taken.push_back(i - start + 1);
    slam.finish();
    return;
  }
  ++outcomes.num_undecided;
  slam.finish();
}

Outcomes relocalize_all(const Walk& walk, const std::vector<int>& starts, int num_map_frames,
                        const Settings& settings, const pipeline::Config& config) {
  Outcomes outcomes;
  const scene::StoredMap map = map_of(walk, num_map_frames, config);
  core::Progress progress("starts", static_cast<int>(starts.size()));
  for (const int start : starts) {
    relocalize(walk, start, settings.num_frames, map, config, outcomes);
    progress.update(outcomes.num_correct + outcomes.num_wrong + outcomes.num_undecided);
  }
  progress.finish();
  return outcomes;
}

std::vector<std::string> row_of(const std::string& source, std::string_view where,
                                const Outcomes& outcomes) {
  std::vector<int> taken = outcomes.frames_taken;
  std::sort(taken.begin(), taken.end());
  return {source,
          std::string(where),
          fmt::format("{}", outcomes.num_correct + outcomes.num_wrong + outcomes.num_undecided),
          fmt::format("{}", outcomes.num_correct),
          fmt::format("{}", outcomes.num_wrong),
          fmt::format("{}", outcomes.num_undecided),
          taken.empty() ? "-" : fmt::format("{}", taken[taken.size() / 2])};
}

void measure_walk(const std::string& source, const Settings& settings, Table& table) {
  pipeline::Config config = pipeline::profile("default");
  config.source = source;
  config.threads = false;
  const Walk walk = walk_of(config);
  config = run::with_window_in_frames(config, walk.info);
  const auto& revisits = walk.truth.revisits;
  if (!revisits || revisits->empty() || !walk.truth.places)
    throw core::InputError(source + ": returns to no place, expected a sequence that does");
  const core::FrameSpan revisit = revisits->front();
  std::vector<int> revisit_frames;
  for (int i = revisit.first; i <= revisit.last; ++i) revisit_frames.push_back(i);
  table.rows.push_back(
      row_of(source, "the place",
             relocalize_all(walk, evenly_spaced(revisit_frames, settings.num_starts), revisit.first,
                            settings, config)));
  const int half = revisit.first / 2;
  const auto lookalikes = evenly_spaced(first_lookalikes(walk, half), settings.num_starts);
  if (lookalikes.empty()) return;
  table.rows.push_back(row_of(source, "only its look-alike",
                              relocalize_all(walk, lookalikes, half, settings, config)));
}

void measure(const Settings& settings) {
  Table table{{"walk", "content of the map", "trials", "correct", "wrong", "undecided",
               "frames until relocalized, median"},
              {}};
  for (int i = 0; i < settings.num_seeds; ++i) {
    measure_walk(fmt::format("twin:{}?seed={}&similarity={}", settings.preset,
                             settings.first_seed + i, settings.similarity),
                 settings, table);
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
  app.add_option("--frames", settings->num_frames,
                 "of a trial; without a pose in them it is undecided")
      ->check(CLI::Range(1, 100000));
  app.add_option("--csv", settings->csv_file, "write the table to this file, too");
  return [settings] { measure(*settings); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
