#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands.hpp"
#include "options.hpp"
#include "print.hpp"
#include "view_options.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/input/camera_file.hpp>
#include <samewhere/report/funnel.hpp>
#include <samewhere/report/html.hpp>
#include <samewhere/report/results_folder.hpp>
#include <samewhere/report/write.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/run/recognition.hpp>
#include <samewhere/run/run.hpp>
#include <samewhere/run/run_odometry.hpp>
#include <samewhere/run/self_calibration.hpp>

namespace samewhere::app {
namespace {

enum class Work { kSlam, kRecognition };

struct RunCommand {
  std::string source;
  std::string out;
  std::string map;        // run only: start in this map
  bool localize = false;  // and leave it as it is
  std::string camera;
  double fov_deg = 0.0;  // run only
  std::string odometry;  // run only
  bool is_realtime = false;
  bool is_forced = false;  // may replace the results of an earlier run
  ConfigOptions config;
  FigureOptions figures;
  ViewOptions view;
};

// A folder name that tells where the run came from: the last part of a path, the preset of a twin.
std::string short_name(const std::string& source) {
  std::string name =
      std::filesystem::path(run::absolute_source(source) + "/").parent_path().filename().string();
  if (name.starts_with("twin:")) name = name.substr(5, name.find('?') - 5);
  for (char& c : name) {
    const bool is_plain =
        std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
    if (!is_plain) c = '-';
  }
  return name;
}

report::ResultsPlace place_for_results(const RunCommand& command, const std::string& source) {
  return {.folder = command.out,
          .name = std::filesystem::path("runs") / short_name(command.source),
          .replaces_earlier = command.is_forced,
          .source = source,
          .known_map = command.map};
}

// What could not be written and why, a line for each.
std::vector<std::string> write(const run::RunOutcome& outcome, Work work,
                               const std::filesystem::path& folder) {
  return work == Work::kSlam
             ? report::write_run(outcome.record, folder)
             : report::write_recognition(outcome.record, outcome.matches, outcome.accepted, folder);
}

// How fast frames come and are done, where reading is part of it: the wait for a frame, which is
// read while the one before it is worked on, and the work. Processor time is the whole program's.
void print_times_with_reading(const core::Timings& timings, double processor_ms) {
  const auto& times = timings.durations_ms();
  const std::vector<double>& work = times.at(report::kWholeFrameStage);
  std::vector<double> both = times.at(report::kWaitForInputStage);
  both.resize(work.size());  // the last wait brings no frame
  std::transform(work.begin(), work.end(), both.begin(), both.begin(), std::plus<>());
  const core::TimingSummary summary = core::summarize(both);
  core::print(
      "  with reading {:.1f} frames per second ({:.1f} ms median, {:.1f} ms p95; {:.1f} ms of "
      "processor time)\n",
      1000.0 * summary.count / summary.total_ms, summary.median_ms, summary.p95_ms,
      processor_ms / summary.count);
}

void print_outcome(const run::RunOutcome& outcome, const std::filesystem::path& folder) {
  const report::RunRecord& record = outcome.record;
  core::print("{}\n", record.title);
  print_figures(record.figures);
  const auto& times = record.timings.durations_ms();
  if (const auto whole = times.find(report::kWholeFrameStage); whole != times.end()) {
    const core::TimingSummary summary = core::summarize(whole->second);
    core::print(
        "  {:.1f} frames per second without reading ({:.1f} ms median, {:.1f} ms p95; {:.1f} ms of "
        "processor time), {:.0f} MiB at most\n",
        1000.0 * summary.count / summary.total_ms, summary.median_ms, summary.p95_ms,
        record.timings.processor_ms().at(report::kWholeFrameStage) / summary.count,
        core::peak_memory_mib());
    if (record.processor_ms) print_times_with_reading(record.timings, *record.processor_ms);
  }
  if (record.first_pose_s)
    core::print("  first pose {:.2f} s after the start\n", *record.first_pose_s);
  core::print("\n");
  core::print("{}\n", report::funnel_text(report::funnel(record.ledger)));
  const std::filesystem::path page = folder / "report.html";
  core::print("{}\n", (core::is_there(page) ? page : folder).string());
}

// A live camera may drop frames. Images and rendered buildings may not: their ground truth refers
// to frame positions.
void require_realtime_as_told(const std::string& source, const core::SourceInfo& info,
                              bool is_realtime) {
  if (info.is_live && !is_realtime) {
    throw core::InputError(source +
                           ": is a live camera; expected --realtime, which drops frames that "
                           "come too fast and counts them");
  }
  if (is_realtime && !info.is_live && !info.is_video) {
    throw core::InputError(source +
                           ": is neither a video nor a camera such as /dev/video0, of which "
                           "--realtime (input.realtime) takes the newest frame");
  }
}

// Where the camera was estimated, the run's folder says what it was: for later runs, and for
// commands that open the recording again.
pipeline::Config with_estimated_camera(pipeline::Config config,
                                       const std::optional<run::SelfCalibration>& calibration,
                                       const std::filesystem::path& folder) {
  if (calibration) config.input.camera = std::filesystem::absolute(folder / "camera.txt").string();
  return config;
}

pipeline::Config config_of(const RunCommand& command, Work work) {
  pipeline::Config config = load(command.config);
  config.source = run::absolute_source(command.source);
  if (command.is_realtime) config.input.realtime = true;
  config.input.needs_calibration = work == Work::kSlam;
  if (work == Work::kRecognition) config = run::without_map(std::move(config));
  if (!command.camera.empty()) config.input.camera = command.camera;
  if (command.fov_deg > 0.0) config.input.fov_deg = command.fov_deg;
  if (!config.input.camera.empty()) config.input.camera = run::absolute_source(config.input.camera);
  if (!command.odometry.empty()) config.odometry.file = command.odometry;
  if (config.odometry.is_used() && work == Work::kRecognition) {
    throw core::InputError(
        "odometry.file: `samewhere loops` estimates no poses; expected `samewhere run`");
  }
  if (config.odometry.is_used()) config.odometry.file = run::absolute_source(config.odometry.file);
  return run::with_odometry_sensor(std::move(config));
}

// At the first good frame. Before, Ctrl-C ends the process at once: there is nothing to finish.
// Settings that find no room are no reason to see nothing: the results are tried, too.
std::filesystem::path begin_results(report::ResultsFolder& results, const pipeline::Config& config,
                                    const std::optional<run::SelfCalibration>& calibration) {
  core::catch_interrupts();
  results.begin();
  try {
    if (calibration)
      core::replace_file(results.path() / "camera.txt",
                         input::camera_file_text(calibration->camera));
    const pipeline::Config kept = with_estimated_camera(config, calibration, results.path());
    core::replace_file(results.path() / "config.yaml", core::config_as_yaml(kept));
  } catch (const core::InputError& error) {
    spdlog::warn("{}; the run goes on", error.what());
  }
  return results.path() / "map.sw";
}

// What is told of a run while it goes on.
struct Listeners {
  std::function<std::filesystem::path()> begin;  // at the first frame; returns the map's file
  run::Watcher* watcher = nullptr;               // optional
};

run::RunOutcome work_on(std::unique_ptr<core::Source> source, const RunCommand& command,
                        const pipeline::Config& config, Work work, const Listeners& listeners) {
  if (work == Work::kRecognition)
    return run::run_recognition(
        std::move(source), config, [&] { listeners.begin(); }, command.figures.is_quiet,
        listeners.watcher);
  return run::run_slam(
      std::move(source), config,
      {.known = command.map, .is_known_fixed = command.localize, .begin = listeners.begin},
      command.figures.is_quiet, listeners.watcher);
}

// Pages that are open show the report until they are closed.
void show_report(view::LiveView& viewer, const report::RunRecord& record) {
  if (record.is_interrupted || viewer.num_pages() == 0) return;
  viewer.finish(report::page_blocks(record));
  core::note("the page shows the report; close it, or Ctrl-C, to end");
  viewer.wait_for_pages();
}

// Each on a line of stderr. Returns the exit code.
int report_errors(const std::vector<std::string>& errors, bool is_interrupted) {
  for (const std::string& error : errors) core::complain("samewhere", error, core::kBadInput);
  if (!errors.empty()) return core::kBadInput;
  return is_interrupted ? core::kInterruptedExit : core::kDone;
}

int execute(const RunCommand& command, Work work) {
  const pipeline::Config config = config_of(command, work);
  report::ResultsFolder results(place_for_results(command, config.source));
  const std::unique_ptr<view::LiveView> viewer = open_live_view(command.view);
  auto source = run::open_source(config);
  require_realtime_as_told(command.source, source->info(), config.input.realtime);
  std::optional<run::SelfCalibration> calibration;
  if (work == Work::kSlam) {
    calibration = run::calibrate_if_unknown(source, config);
    run::require_slam_input(source->info(), config);
  }
  run::RunOutcome outcome =
      work_on(std::move(source), command, config, work,
              {[&] { return begin_results(results, config, calibration); }, viewer.get()});
  report::RunRecord& record = outcome.record;
  if (calibration) record.figures.push_back(run::focal_length_figure(*calibration));
  std::vector<std::string> errors;
  if (results.has_begun()) {
    record.config_yaml =
        core::config_as_yaml(with_estimated_camera(config, calibration, results.path()));
    errors = write(outcome, work, results.path());
    if (command.figures.prints_text()) print_outcome(outcome, results.path());
    write_json(record.title, record.figures, command.figures);
    if (viewer) show_report(*viewer, record);
  } else if (!record.input_error && !record.is_interrupted) {
    throw core::InputError(command.source + ": gives no frame");
  }
  for (const auto& error : {record.input_error, outcome.map_error})
    if (error) errors.push_back(*error);
  return report_errors(errors, record.is_interrupted);
}

void add_fov_option(CLI::App& sub, RunCommand& command) {
  sub.add_option("--fov", command.fov_deg,
                 "horizontal field of view in degrees of one camera without calibration; without "
                 "it guessed and then estimated")
      ->check(CLI::Range(5.0, 170.0));
}

void add_prior_option(CLI::App& sub, RunCommand& command) {
  sub.add_option_function<std::string>(
         "--prior",
         [&command](const std::string& prior) {
           command.config.assignments.push_back("verify.prior=" + prior);
         },
         "what is known of the building: repetitive (default), places may look alike and "
         "appearance alone accepts nothing; unique, no two places look alike")
      ->type_name("repetitive|unique");
}

void add_map_options(CLI::App& sub, RunCommand& command) {
  CLI::Option* map = sub.add_option("--map", command.map,
                                    "start LOST in this map and relocalize; the map is extended");
  sub.add_flag("--localize", command.localize, "do not extend the map of --map")->needs(map);
}

void add_odometry_option(CLI::App& sub, RunCommand& command) {
  sub.add_option("--odometry", command.odometry,
                 "odometry of the body: a file of lines `stamp tx ty tz qx qy qz qw`, with or "
                 "without covariances, or a bag; poses are taken from it and corrected by loops. "
                 "odometry.sensor names its drift");
}

void add_topics_option(CLI::App& sub, RunCommand& command) {
  sub.add_option_function<std::string>(
         "--topics",
         [&command](const std::string& topics) {
           command.config.assignments.push_back("input.topics=" + topics);
         },
         "topics of a bag by their roles: \"color=/a depth=/b\"; roles: color, right, depth, "
         "camera_info, right_camera_info, imu, odometry, truth; `depth=none` leaves one out; "
         "`samewhere info` lists topics")
      ->type_name("ROLE=TOPIC");
}

CLI::App* add_source_command(CLI::App& app, const char* name, const char* what, Work work,
                             int& exit_code) {
  auto command = std::make_shared<RunCommand>();
  if (work == Work::kRecognition) command->config.profile = "recognition";
  CLI::App* sub = app.add_subcommand(name, what);
  sub->add_option(
         "SOURCE", command->source,
         "a folder (TUM RGB-D, EuRoC, KITTI, 7-Scenes, HoloLens, images), a list of images, a "
         "bag (.mcap, .db3, .bag, a folder of rosbag2), a video, a camera (/dev/video0), or "
         "twin:PRESET?seed=3")
      ->required();
  sub->add_option("--out", command->out,
                  "folder for the results; without it a new folder runs/NAME");
  sub->add_flag("--force", command->is_forced,
                "replace the results of an earlier run in --out, from the first good frame on");
  sub->add_option("--camera", command->camera,
                  "camera file of `samewhere calibrate`, OpenCV, ORB-SLAM, ROS, Kalibr, COLMAP or "
                  "JSON; without "
                  "it that of the recording");
  sub->add_flag("--realtime", command->is_realtime,
                "process a camera or a video in real time: always the newest frame, others are "
                "dropped and counted; results differ from run to run");
  add_topics_option(*sub, *command);
  add_config_options(*sub, command->config);
  add_prior_option(*sub, *command);
  add_json_option(*sub, command->figures);
  add_quiet_flag(*sub, command->figures);
  sub->add_flag_callback(
      "--measure-all",
      [command] { command->config.assignments.push_back("verify.measure_all=true"); },
      "also measure candidates that verify.min_similarity or verify.pause_frames reject, for "
      "`ledger RUN replay`");
  if (work == Work::kSlam) add_fov_option(*sub, *command);
  if (work == Work::kSlam) add_odometry_option(*sub, *command);
  if (work == Work::kSlam) add_map_options(*sub, *command);
  add_view_options(*sub, command->view,
                   "show the run in a browser while it goes on; the results are the same. The "
                   "program ends when the page is closed");
  sub->callback([command, work, &exit_code] { exit_code = execute(*command, work); });
  return sub;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  add_source_command(app, "run", "SLAM: trajectory, map and verified loop closures of a recording",
                     Work::kSlam, exit_code)
      ->footer(
          "Examples:\n"
          "  samewhere run twin:twin-corridors --out runs/twin  the rendered building, no "
          "download\n"
          "  samewhere run ~/data/fr1_room                      a TUM RGB-D folder with "
          "camera.txt\n"
          "  samewhere run walk.mp4 --camera camera.txt         a video\n"
          "  samewhere run walk.mp4 --camera camera.txt --realtime  in real time, as a live "
          "camera\n"
          "  samewhere run walk.mcap                            a bag, its topics found by "
          "themselves\n"
          "  samewhere run drive --odometry wheels.tum --set odometry.sensor=wheel  own odometry\n"
          "  samewhere run kitchen --set verify.min_inliers=60  one setting changed\n"
          "  samewhere run flat --prior unique                  no two places look alike: "
          "appearance accepts\n"
          "  samewhere run walk.mcap --view                     watched in a browser while it "
          "goes on\n"
          "  samewhere run today --map runs/kitchen/map.sw --localize  localize in a saved "
          "map");
}

void add_loops_command(CLI::App& app, int& exit_code) {
  add_source_command(app, "loops",
                     "Place recognition without SLAM: frames that show an earlier place",
                     Work::kRecognition, exit_code)
      ->footer(
          "Examples:\n"
          "  samewhere loops photos/ --set retrieve.window_frames=20  images in the order of their "
          "numbers\n"
          "  samewhere loops flat --prior unique                      no two places look alike\n"
          "  samewhere loops corridor --profile paper                 the published method\n"
          "  samewhere loops flat --view                              watched in a browser\n"
          "Precision and recall are printed where the folder holds same_place.txt or "
          "same_place.pgm.");
}

}  // namespace samewhere::app
