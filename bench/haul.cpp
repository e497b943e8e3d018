// haul: do time and memory stay what they are when a walk goes on and on?
#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <malloc.h>

#include "program.hpp"
#include <samewhere/core/progress.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/report/funnel.hpp>
#include <samewhere/run/map_saver.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/run/prior.hpp>
#include <samewhere/run/run_metrics.hpp>

namespace samewhere::bench {
namespace {

struct Settings {
  std::string source = "twin:long-haul?seed=1000";
  int num_frames = 0;  // 0: all
  int num_parts = 9;
  int keyframes_in_memory = pipeline::Config{}.map.keyframes_in_memory;
  bool close_loops = true;
  std::string map_file;
  std::string csv_file;
  std::vector<std::string> assignments;  // "section.key=value", on top of the profile
};

constexpr double kBytesPerMib = 1024.0 * 1024.0;

struct Memory {
  double own_mib = 0.0;
  double used_mib = 0.0;  // of it: what the program asked for and has not given back
  double mapped_mib = 0.0;
};

// Of this process now (proc(5), mallinfo(3)).
Memory memory_now() {
  std::ifstream status("/proc/self/status");
  Memory memory;
  std::string name;
  for (double kib = 0.0; status >> name;) {
    if (name == "RssAnon:" && status >> kib) memory.own_mib = kib / 1024.0;
    if (name == "RssFile:" && status >> kib) memory.mapped_mib = kib / 1024.0;
    status.ignore(1000, '\n');
  }
  const struct mallinfo2 heap = mallinfo2();
  memory.used_mib = static_cast<double>(heap.uordblks + heap.hblkhd) / kBytesPerMib;
  return memory;
}

// What the frames of one part of the walk took.
struct Part {
  std::vector<double> wall_ms;
  std::vector<double> processor_ms;  // of tracking alone
};

// Median, p99, worst.
std::string in_short(const std::vector<double>& ms) {
  if (ms.empty()) return "";
  const core::TimingSummary summary = core::summarize(ms);
  return fmt::format("{:.1f} / {:.1f} / {:.1f}", summary.median_ms, summary.p99_ms,
                     *std::max_element(ms.begin(), ms.end()));
}

class Haul {
 public:
  // The map is saved as it grows, if a file is named.
  Haul(const pipeline::Config& config, const std::string& map_file)
      : checks_(config.verify),
        source_(run::open_source(config)),
        slam_(run::with_window_in_frames(config, source_->info()), pipeline::DepthFrom::kSensor,
              keep_map()) {
    if (!map_file.empty()) saver_.emplace(map_file, config, slam_.describer_checksum());
  }

  // Row by row: a part of the walk.
  Table run(int num_parts) {
    const int num_frames = source_->info().num_frames;
    const int part_size = std::max(1, num_frames / num_parts);
    core::Progress progress("frames", num_frames);
    for (int i = 0; const auto frame = source_->next(); ++i) {
      feed(*frame);
      progress.update(i + 1);
      if ((i + 1) % part_size == 0 || i + 1 == num_frames) end_part(i + 1);
    }
    progress.finish();
    slam_.finish();
    if (saver_ && saver_->error()) throw core::InputError(*saver_->error());
    saver_.reset();
    return std::move(table_);
  }

  // What of it grows with the map: wall times of each stage, of the first third of its calls and of
  // the last.
  Table stages() const {
    Table table{{"stage", "times", "first third, ms median / p99 / worst", "last third"}, {}};
    const core::Timings timings = slam_.timings();
    for (const auto& [stage, ms] : timings.durations_ms()) {
      const auto third = static_cast<std::ptrdiff_t>(ms.size() / 3);
      table.rows.push_back({stage, std::to_string(ms.size()),
                            in_short({ms.begin(), ms.begin() + third}),
                            in_short({ms.end() - third, ms.end()})});
    }
    return table;
  }

  // How good it is, by docs/evaluation.md.
  Table quality() const {
    run::SlamFindings findings;
    findings.num_frames = static_cast<int>(slam_.frames().size());
    findings.trajectory = pipeline::trajectory_of(slam_.map(), slam_.frames());
    findings.odometry = pipeline::odometry_of(slam_.map(), slam_.frames());
    run::StampOf stamp_of;
    for (const auto& frame : slam_.frames()) stamp_of[frame.frame] = frame.stamp_s;
    run::add_loops(slam_.ledger(), stamp_of, findings);
    core::Truth truth;
    truth.trajectory = source_->true_trajectory();  // which places are one is a matrix too large
    Table table{{"figure", "value"}, {}};
    for (const auto& figure : run::figures_of(run::evaluate_slam(findings, truth)))
      table.rows.push_back({figure.name, figure.value});
    const auto prior = run::prior_figure(slam_.ledger(), checks_);
    table.rows.push_back({prior.name, prior.value});
    table.rows.push_back({"live landmarks", std::to_string(num_live(slam_.map().landmarks))});
    return table;
  }

  // What each check rejected, and how many candidates are ambiguous at the end.
  std::string funnel() const { return report::funnel_text(report::funnel(slam_.ledger())); }

 private:
  pipeline::KeepMap keep_map() {
    return [this](const scene::MapVersion& map, const pipeline::MapNews& news) {
      num_keyframes_ = map.keyframes.size();
      num_live_keyframes_ = num_live(map.keyframes);
      num_landmarks_ = map.landmarks.size();
      num_loops_ = map.loops.size();
      if (saver_) saver_->save(map, news);
    };
  }

  void feed(const core::Frame& frame) {
    const double before_ms = core::thread_processor_ms();
    const auto start = std::chrono::steady_clock::now();
    slam_.feed(frame);
    const std::chrono::duration<double, std::milli> spent =
        std::chrono::steady_clock::now() - start;
    part_.wall_ms.push_back(spent.count());
    part_.processor_ms.push_back(core::thread_processor_ms() - before_ms);
  }

  void end_part(int num_fed) {
    const core::TimingSummary wall = core::summarize(part_.wall_ms);
    const core::TimingSummary own = core::summarize(part_.processor_ms);
    const Memory memory = memory_now();
    table_.rows.push_back(
        {std::to_string(num_fed), std::to_string(num_keyframes_),
         std::to_string(num_live_keyframes_), std::to_string(num_landmarks_),
         std::to_string(num_loops_), fmt::format("{:.1f} / {:.1f}", own.median_ms, own.p99_ms),
         fmt::format("{:.1f} / {:.1f}", wall.median_ms, wall.p99_ms),
         fmt::format("{:.0f}", memory.own_mib), fmt::format("{:.0f}", memory.used_mib),
         fmt::format("{:.0f}", memory.mapped_mib)});
    part_ = {};
  }

  // of the map that mapping kept last, in its thread
  std::atomic<std::size_t> num_keyframes_ = 0;
  std::atomic<std::size_t> num_live_keyframes_ = 0;
  std::atomic<std::size_t> num_landmarks_ = 0;
  std::atomic<std::size_t> num_loops_ = 0;
  Part part_;
  Table table_{{"frames", "keyframes", "live", "landmarks ever", "loops",
                "tracking, processor ms median / p99", "wall ms median / p99", "memory MiB",
                "in use MiB", "mapped files MiB"},
               {}};
  verify::Config checks_;
  std::unique_ptr<core::Source> source_;
  std::optional<run::MapSaver> saver_;  // from the first frame on in mapping's thread
  pipeline::Slam slam_;
};

void measure(const Settings& settings) {
  pipeline::Config config = pipeline::profile("default");
  config.source = settings.source;
  config.close_loops = settings.close_loops;
  config.twin.num_frames = settings.num_frames;
  config.map.keyframes_in_memory = settings.keyframes_in_memory;
  for (const auto& assignment : settings.assignments) core::set_config(config, assignment);
  Haul haul(config, settings.map_file);
  const Table table = haul.run(settings.num_parts);
  publish(table, settings.csv_file);
  publish(haul.stages(), "");
  publish(haul.quality(), "");
  fmt::print("{}", haul.funnel());
  fmt::print("peak memory {:.0f} MiB\n", core::peak_memory_mib());
}

std::function<void()> set_up(CLI::App& app) {
  const auto settings = std::make_shared<Settings>();
  app.name("haul");
  app.description("Time and memory of a long walk, part by part.");
  app.add_option("--source", settings->source, "with depth");
  app.add_option("--frames", settings->num_frames, "of a building's walk; 0: all")
      ->check(CLI::Range(0, 1000000));
  app.add_option("--parts", settings->num_parts, "of the walk, a row each")
      ->check(CLI::Range(1, 1000));
  app.add_option("--in-memory", settings->keyframes_in_memory,
                 "keyframes whose features and landmarks stay in memory")
      ->check(CLI::Range(1, 1000000));
  app.add_option("--close-loops", settings->close_loops, "whether loops are looked for");
  app.add_option("--map", settings->map_file, "save the map in this new file")
      ->check(CLI::NonexistentPath);
  app.add_option("--set", settings->assignments,
                 "one setting, e.g. verify.asked_again_per_keyframe=0")
      ->allow_extra_args(false);
  app.add_option("--csv", settings->csv_file, "write the table to this file, too");
  return [settings] { measure(*settings); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
