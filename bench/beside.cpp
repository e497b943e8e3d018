// beside: does loop closing in parallel slow tracking?
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "program.hpp"
#include "walk.hpp"
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/run/open_source.hpp>

namespace samewhere::bench {
namespace {

struct Settings {
  std::vector<std::string> sources;
  int num_passes = 3;
  std::string csv_file;
};

// Frames come when the camera gave them, or each as soon as the last is done with.
enum class Pace { kOfTheCamera, kAsFastAsItCan };

// How long a frame's tracking took.
core::TimingSummary tracking_of(const Walk& walk, const pipeline::Config& config, Pace pace) {
  using Seconds = std::chrono::duration<double>;
  pipeline::Slam slam(config);
  const auto start = std::chrono::steady_clock::now();
  for (const core::Frame& frame : walk.frames) {
    core::stop_if_interrupted();
    if (pace == Pace::kOfTheCamera)
      std::this_thread::sleep_until(start + Seconds(frame.stamp_s - walk.frames.front().stamp_s));
    slam.feed(frame);
  }
  slam.finish();
  return core::summarize(slam.timings().durations_ms().at("track"));
}

// Of one walk at one pace, with loops or without: a pass after the other.
struct Passes {
  bool close_loops = true;
  std::vector<core::TimingSummary> tracking;

  std::string in_turn(double core::TimingSummary::*figure) const {
    std::vector<std::string> texts;
    for (const auto& pass : tracking) texts.push_back(fmt::format("{:.1f}", pass.*figure));
    return fmt::format("{}", fmt::join(texts, " "));
  }
  double mean(double core::TimingSummary::*figure) const {
    double sum = 0.0;
    for (const auto& pass : tracking) sum += pass.*figure;
    return sum / static_cast<double>(tracking.size());
  }
};

void measure_walk(const std::string& source, const Settings& settings, Table& table) {
  pipeline::Config config = pipeline::profile("default");
  config.source = source;
  const Walk walk = walk_of(config);
  config = run::with_window_in_frames(config, walk.info);
  for (const Pace pace : {Pace::kOfTheCamera, Pace::kAsFastAsItCan}) {
    Passes with{true, {}};
    Passes without{false, {}};
    core::Progress progress("passes", 2 * settings.num_passes);
    for (int pass = 0; pass < settings.num_passes; ++pass) {
      // so that neither always finds the caches cold
      const bool is_with_first = pass % 2 == 0;
      for (Passes* passes : {is_with_first ? &with : &without, is_with_first ? &without : &with}) {
        config.close_loops = passes->close_loops;
        passes->tracking.push_back(tracking_of(walk, config, pace));
        progress.update(static_cast<int>(with.tracking.size() + without.tracking.size()));
      }
    }
    progress.finish();
    for (const Passes& passes : {with, without}) {
      using Summary = core::TimingSummary;
      table.rows.push_back(
          {walk.info.name, pace == Pace::kOfTheCamera ? "of the camera" : "as fast as it can",
           passes.close_loops ? "true" : "false", passes.in_turn(&Summary::median_ms),
           passes.in_turn(&Summary::p95_ms), passes.in_turn(&Summary::p99_ms),
           fmt::format("{:.2f}", passes.mean(&Summary::p99_ms) / without.mean(&Summary::p99_ms))});
    }
  }
}

void measure(const Settings& settings) {
  Table table{{"walk", "pace", "close_loops", "median ms of each pass", "p95 ms", "p99 ms",
               "mean p99 to that without"},
              {}};
  for (const std::string& source : settings.sources) measure_walk(source, settings, table);
  publish(table, settings.csv_file);
}

std::function<void()> set_up(CLI::App& app) {
  const auto settings = std::make_shared<Settings>();
  app.name("beside");
  app.description(
      "Time of tracking per frame with parallel loop closing (loop verifier; correction and full "
      "bundle adjustment once a loop is accepted) and without, in turn, at the frame rate of the "
      "camera and as fast as possible. Images are read before; no other program should run.");
  app.add_option("sources", settings->sources, "recordings, or sequences as twin:mirror?seed=1000")
      ->required();
  app.add_option("--passes", settings->num_passes, "of each")->check(CLI::Range(1, 100));
  app.add_option("--csv", settings->csv_file, "write the table to this file, too");
  return [settings] { measure(*settings); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
