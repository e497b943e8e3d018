#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "commands.hpp"
#include "options.hpp"
#include "print.hpp"
#include <samewhere/core/interrupt.hpp>
#include <samewhere/run/export.hpp>

namespace samewhere::app {
namespace {

struct ExportCommand {
  std::string run;
  std::string format;
  run::ExportRequest request;
};

std::string rows_of_formats() {
  std::string rows;
  for (const run::ExportFormat& format : run::export_formats())
    rows += fmt::format("  {:<12}RUN/{:<20}{}\n", format.name,
                        std::string(format.default_name) + (format.is_folder ? "/" : ""),
                        format.content);
  return rows;
}

void execute(ExportCommand command) {
  core::catch_interrupts();
  command.request.run = as_run_folder(command.run);
  command.request.map = as_map_file(command.run);
  print_figures(run::export_run(command.format, command.request));
}

}  // namespace

void add_export_command(CLI::App& app) {
  auto command = std::make_shared<ExportCommand>();
  run::ExportRequest& request = command->request;
  std::vector<std::string> names;
  for (const run::ExportFormat& format : run::export_formats()) names.emplace_back(format.name);
  CLI::App* sub = app.add_subcommand(
      "export", "Write a finished run as the input of COLMAP, nerfstudio and other programs");
  sub->add_option("RUN", command->run, "folder that `samewhere run` wrote, or the map in it")
      ->required();
  sub->add_option("--to", command->format, fmt::format("format: {}", fmt::join(names, ", ")))
      ->required();
  sub->add_option("--out", request.out, "file or folder to write; default: see below");
  sub->add_flag("--force", request.replaces_earlier, "replace an earlier export");
  sub->add_flag("--binary", request.is_binary, "colmap: .bin files in place of .txt");
  sub->add_flag("--undistort", request.is_undistorted,
                "colmap, nerfstudio: pictures without distortion, with a PINHOLE camera");
  sub->add_option("--session", request.session,
                  "session whose frames are exported, 0 = the run that made the map; required if "
                  "the map holds several")
      ->check(CLI::Range(0, 1'000'000));
  sub->footer("Formats, default output, content:\n" + rows_of_formats() +
              "colmap and nerfstudio read the pictures of the run's source once more.\n"
              "Examples:\n"
              "  samewhere export runs/kitchen --to colmap\n"
              "  samewhere export runs/kitchen --to nerfstudio --undistort --out kitchen-nerf\n"
              "  samewhere export runs/kitchen --to las --out kitchen.las");
  sub->callback([command] { execute(*command); });
}

}  // namespace samewhere::app
