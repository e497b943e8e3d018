#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "commands.hpp"
#include "options.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/evaluate/degraded_odometry.hpp>
#include <samewhere/report/jpeg.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/twin/front/contact_sheet.hpp>
#include <samewhere/twin/front/dataset.hpp>
#include <samewhere/twin/front/twin.hpp>

namespace samewhere::app {
namespace {

struct TwinCommand {
  std::string source;
  std::string out;
  std::string format = "tum";
  ConfigOptions config;
  std::string sheet;
  std::string similarity_sheet;
  std::string odometry;
  std::string degrade = "2%";
  std::uint64_t odometry_seed = 0;
  bool is_list = false;
};

bool writes_folder_or_sheet(const TwinCommand& command) {
  return !command.out.empty() || !command.sheet.empty() || !command.similarity_sheet.empty();
}

void print_presets() {
  std::size_t width = 0;
  for (const auto& preset : twin::list_presets()) width = std::max(width, preset.name.size());
  for (const auto& preset : twin::list_presets()) {
    core::print("twin:{:<{}}  {}\n", preset.name, width, preset.what);
  }
}

bool has_sheet(const TwinCommand& command) {
  return !command.sheet.empty() || !command.similarity_sheet.empty();
}

// Before anything is rendered.
void check_sheet(const std::string& file) {
  if (file.empty()) return;
  std::string ending = std::filesystem::path(file).extension();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (ending != ".jpg" && ending != ".jpeg") {
    throw core::InputError(file + ": a sheet is a JPEG file; expected a name that ends in .jpg");
  }
  const auto folder = std::filesystem::absolute(file).parent_path();
  std::error_code unknown;
  if (std::filesystem::is_directory(folder, unknown)) return;
  throw core::InputError(
      fmt::format("{}: there is no folder {}; expected one to write into", file, folder.string()));
}

void write_sheet(const std::string& file, const cv::Mat& sheet) {
  core::write_file(file, report::jpeg_bytes(sheet, sheet.cols));
  core::print("{}\n", file);
}

void write_sheets(const TwinCommand& command, const twin::Walkthrough& walk,
                  const twin::Config& config) {
  if (!command.sheet.empty()) write_sheet(command.sheet, twin::contact_sheet(walk, config));
  if (!command.similarity_sheet.empty()) {
    write_sheet(command.similarity_sheet, twin::similarity_sheet(walk.spec(), config));
  }
}

void check(const TwinCommand& command) {
  if (command.source.empty()) {
    throw core::InputError("twin: no building was named; expected twin:PRESET or --list");
  }
  if (!writes_folder_or_sheet(command) && command.odometry.empty()) {
    throw core::InputError(
        "twin: no folder was named; expected --out DIR (must not exist), --sheet FILE.jpg or "
        "--odometry FILE.tum");
  }
  if (command.format != "tum" && command.format != "euroc") {
    throw core::InputError(fmt::format("--format {}: expected one of: tum, euroc", command.format));
  }
  check_sheet(command.sheet);
  check_sheet(command.similarity_sheet);
}

void write_folder(const TwinCommand& command, core::Source& source,
                  const twin::MakeTables& tables) {
  if (command.format == "tum") {
    twin::write_tum_folder(source, command.out, tables);
  } else {
    twin::write_euroc_folder(source, command.out, tables);
  }
}

void write_walk(const TwinCommand& command, const pipeline::Config& config) {
  const auto walk =
      std::make_shared<const twin::Walkthrough>(twin::parse_spec(config.source), config.twin);
  // the folder first: a name that is taken is told before anything is rendered
  if (!command.out.empty()) {
    const auto source = twin::open_twin(walk, config.twin);
    const auto tables = [&walk] {
      return twin::SideTables{twin::watched_truth(*walk), walk->wheels()};
    };
    write_folder(command, *source, tables);
    core::print("{}: {} frames of {}, {} true loops, {} aliased pairs\n", command.out,
                walk->num_frames(), command.source, walk->truth().loops.size(),
                walk->truth().aliased_pairs.size());
  }
  write_sheets(command, *walk, config.twin);
}

// The true poses of the body: of a trajectory file those that it has.
core::Trajectory true_body_poses(const pipeline::Config& config) {
  const std::filesystem::path file = config.source;
  if (file.extension() == ".tum") return core::read_tum(file);
  const auto source = run::open_source(config);
  core::Trajectory poses = source->true_trajectory();
  if (poses.empty()) {
    throw core::InputError(config.source +
                           ": has no true trajectory; expected a recording with ground truth or a "
                           "trajectory FILE.tum");
  }
  const auto frame = source->next();
  if (!frame) throw core::InputError(config.source + ": gives no frame");
  const core::Rigid3 camera_from_body = inverse(frame->rig->body_from_told_camera());
  for (core::StampedPose& pose : poses)
    pose.world_from_camera = pose.world_from_camera * camera_from_body;
  return poses;
}

void write_odometry(const TwinCommand& command, const pipeline::Config& config) {
  const evaluate::Degradation degradation = evaluate::degradation_of(command.degrade);
  const core::Trajectory rows =
      evaluate::degraded(true_body_poses(config), degradation, command.odometry_seed);
  core::write_file(command.odometry, core::tum_text(rows));
  core::print("{}: {} rows of odometry, {}\n", command.odometry, rows.size(), command.degrade);
}

void write(const TwinCommand& command) {
  check(command);
  core::catch_interrupts();
  pipeline::Config config = load(command.config);
  config.source = run::absolute_source(command.source);
  if (!command.odometry.empty()) write_odometry(command, config);
  if (!writes_folder_or_sheet(command)) return;
  if (twin::is_twin_spec(config.source)) {
    write_walk(command, config);
    return;
  }
  if (has_sheet(command)) {
    throw core::InputError(command.source +
                           ": a sheet needs a rendered building; expected twin:PRESET");
  }
  const auto source = run::open_source(config);
  write_folder(command, *source, nullptr);
  core::print("{}: {} frames of {}\n", command.out, source->info().num_frames, command.source);
}

// --list prints the presets only; other options would be ignored.
void check_list_stands_alone(const CLI::App& command, const CLI::Option& list) {
  for (const CLI::Option* option : command.get_options()) {
    if (option == &list || option->count() == 0) continue;
    throw core::InputError("twin: found " + option->get_name() +
                           " beside --list, which prints the presets; expected --list alone");
  }
}

void add_odometry_options(CLI::App& sub, TwinCommand& command) {
  CLI::Option* odometry = sub.add_option("--odometry", command.odometry,
                                         "write odometry with known errors for `run --odometry`; "
                                         "SOURCE may be a trajectory FILE.tum, too");
  sub.add_option("--degrade", command.degrade,
                 "its errors: a share of the distance (5%), heading drift (1deg/m), slip, outage, "
                 "lift, or several joined by +")
      ->capture_default_str()
      ->needs(odometry);
  sub.add_option("--odometry-seed", command.odometry_seed, "seed of its errors")
      ->capture_default_str()
      ->needs(odometry);
}

constexpr const char* kTwinKeysAndExamples =
    "Keys of twin:PRESET?KEY=VALUE&KEY=VALUE: seed; similarity, 0 to 1; speed, 0.5 to 2; people, "
    "0 to 30;\n"
    "stray, 0 to 1: lateral deviation of the path in m, with camera shake;\n"
    "copy, 0 to 1000: another building of the same design, with its own small things;\n"
    "camera: rgbd, stereo or mono.\n\n"
    "Examples:\n"
    "  samewhere twin --list\n"
    "  samewhere twin 'twin:hotel?seed=3&similarity=0.9' --out hotel --format tum\n"
    "  samewhere twin 'twin:mirror?camera=stereo' --out mirror --format euroc\n"
    "  samewhere twin 'twin:warehouse?people=5' --sheet warehouse.jpg\n"
    "  samewhere twin twin:office-loop --odometry poor.tum --degrade 5%+slip\n"
    "  samewhere twin twin:office-loop --out short --set twin.num_frames=100";

}  // namespace

void add_twin_command(CLI::App& app) {
  auto command = std::make_shared<TwinCommand>();
  CLI::App* sub = app.add_subcommand(
      "twin", "Export a rendered sequence through a building with look-alike places as a data set");
  sub->add_option("SOURCE", command->source,
                  "twin:PRESET?seed=3&similarity=0.9, or any recording that `run` reads");
  CLI::Option* out = sub->add_option("--out", command->out, "folder to write; it must not exist");
  sub->add_option("--format", command->format,
                  "tum (TUM RGB-D: colour, depth, poses) or euroc (EuRoC: one or two cameras, "
                  "inertial samples, poses)")
      ->capture_default_str()
      ->needs(out);
  sub->add_option("--sheet", command->sheet, "JPEG file with twelve frames of the sequence");
  sub->add_option("--similarity-sheet", command->similarity_sheet,
                  "JPEG file with a place and its look-alike at similarity 0, 0.5, 0.9 and 1, "
                  "regardless of SOURCE");
  add_odometry_options(*sub, *command);
  const CLI::Option* list =
      sub->add_flag("--list", command->is_list, "print the presets, one per line");
  add_config_options(*sub, command->config);
  sub->footer(kTwinKeysAndExamples);
  sub->callback([command, sub, list] {
    if (command->is_list) {
      check_list_stands_alone(*sub, *list);
      print_presets();
    } else {
      write(*command);
    }
  });
}

}  // namespace samewhere::app
