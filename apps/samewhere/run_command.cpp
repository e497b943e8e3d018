#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "commands.hpp"
#include "options.hpp"
#include "print.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/pipeline/open_source.hpp>
#include <samewhere/pipeline/run.hpp>
#include <samewhere/report/funnel.hpp>
#include <samewhere/report/write.hpp>

namespace samewhere::app {
namespace {

enum class Work { kSlam, kRecognition };

struct RunCommand {
  std::string source;
  std::string out;
  ConfigOptions config;
};

// A folder name that tells where the run came from: the last part of a path, the preset of a twin.
std::string short_name(const std::string& source) {
  std::string name = std::filesystem::path(pipeline::absolute_source(source) + "/")
                         .parent_path()
                         .filename()
                         .string();
  if (name.starts_with("twin:")) name = name.substr(5, name.find('?') - 5);
  for (char& c : name) {
    const bool is_plain =
        std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
    if (!is_plain) c = '-';
  }
  return name;
}

// runs/NAME, or runs/NAME-2 and so on: never one that is there.
std::filesystem::path unused_folder(const std::string& source) {
  const std::filesystem::path first = std::filesystem::path("runs") / short_name(source);
  std::filesystem::path folder = first;
  for (int number = 2; std::filesystem::exists(folder); ++number) {
    folder = first.string() + "-" + std::to_string(number);
  }
  return folder;
}

void write(const pipeline::RunOutcome& outcome, Work work, const std::filesystem::path& folder) {
  if (work == Work::kSlam) {
    report::write_run(outcome.record, folder);
  } else {
    report::write_recognition(outcome.record, outcome.matches, outcome.accepted, folder);
  }
}

void print_outcome(const pipeline::RunOutcome& outcome, const std::filesystem::path& folder) {
  const report::RunRecord& record = outcome.record;
  fmt::print("{}\n", record.title);
  print_figures(record.figures);
  const auto& times = record.timings.durations_ms();
  if (const auto whole = times.find(report::kWholeFrameStage); whole != times.end()) {
    const core::TimingSummary summary = core::summarize(whole->second);
    fmt::print(
        "  {:.1f} frames per second without reading ({:.1f} ms median, {:.1f} ms p95), {:.0f} MiB "
        "at most\n\n",
        1000.0 * summary.count / summary.total_ms, summary.median_ms, summary.p95_ms,
        core::peak_memory_mib());
  }
  fmt::print("{}\n", report::funnel_text(report::funnel(record.ledger)));
  fmt::print("{}\n", (folder / "report.html").string());
}

// What an earlier run left in the folder would be taken for this one's.
void remove_old_results(const std::filesystem::path& folder) {
  for (const char* name :
       {"trajectory.tum", "odometry.tum", "frames.csv", "map.ply", "matches.txt", "accepted.txt",
        "loops.json", "config.yaml", "timing.json", "report.html"}) {
    std::error_code ignored;  // a file that stays will be written over, or fail loudly then
    std::filesystem::remove(folder / name, ignored);
  }
}

int execute(const RunCommand& command, Work work) {
  core::catch_interrupts();
  pipeline::Config config = load(command.config);
  config.source = pipeline::absolute_source(command.source);
  if (!config.input.camera.empty())
    config.input.camera = pipeline::absolute_source(config.input.camera);
  const std::filesystem::path folder =
      command.out.empty() ? unused_folder(command.source) : std::filesystem::path(command.out);
  auto source = pipeline::open_source(config);
  if (work == Work::kSlam) pipeline::require_slam_input(source->info(), config);
  // only now, so that a bad source leaves no folder behind; and not later, so that a folder that
  // cannot be written is found out before the work is done
  core::make_writable_folder(folder);
  remove_old_results(folder);
  const pipeline::RunOutcome outcome = work == Work::kSlam
                                           ? pipeline::run_slam(std::move(source), config)
                                           : pipeline::run_recognition(std::move(source), config);
  write(outcome, work, folder);
  print_outcome(outcome, folder);
  if (outcome.record.input_error) throw core::InputError(*outcome.record.input_error);
  return outcome.record.is_interrupted ? core::kInterruptedExit : core::kDone;
}

CLI::App* add_source_command(CLI::App& app, const char* name, const char* what, Work work,
                             int& exit_code) {
  auto command = std::make_shared<RunCommand>();
  CLI::App* sub = app.add_subcommand(name, what);
  sub->add_option("SOURCE", command->source,
                  "a folder (TUM RGB-D, EuRoC, 7-Scenes, HoloLens, images), a list of images, or "
                  "twin:PRESET?seed=3")
      ->required();
  sub->add_option("--out", command->out,
                  "folder for the results; without it runs/NAME, never overwriting");
  add_config_options(*sub, command->config);
  sub->callback([command, work, &exit_code] { exit_code = execute(*command, work); });
  return sub;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  add_source_command(app, "run", "SLAM: trajectory, map and judged loops of a recording",
                     Work::kSlam, exit_code)
      ->footer(
          "Examples:\n"
          "  samewhere run twin:twin-corridors --out runs/demo  the built-in world, no download\n"
          "  samewhere run ~/data/fr1_room                      a TUM RGB-D folder with "
          "camera.txt\n"
          "  samewhere run kitchen --set verify.min_inliers=60  one setting changed");
}

void add_loops_command(CLI::App& app, int& exit_code) {
  add_source_command(app, "loops", "Recognition alone: which frames show a place seen before",
                     Work::kRecognition, exit_code)
      ->footer(
          "Examples:\n"
          "  samewhere loops photos/ --set retrieve.window_frames=20  images in the order of their "
          "numbers\n"
          "  samewhere loops corridor --profile paper                 the published method\n"
          "Precision and recall are printed where the folder holds same_place.txt or "
          "same_place.pgm.");
}

}  // namespace samewhere::app
