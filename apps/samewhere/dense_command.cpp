#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "options.hpp"
#include "print.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/folder_lock.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/run/dense_maps.hpp>
#include <samewhere/run/run_folder.hpp>

namespace samewhere::app {
namespace {

struct DenseCommand {
  std::string run;
  run::DenseFiles files;
  std::vector<std::string> assignments;
};

void execute(const DenseCommand& command) {
  core::catch_interrupts();
  const std::filesystem::path run = command.run;
  pipeline::Config config = run::config_of_run(run);
  for (const auto& assignment : command.assignments) core::set_config(config, assignment);
  run::DenseFiles files = command.files;
  const bool asks_for_grid = !files.grid.empty();
  std::optional<core::FolderLock> lock;  // no run may replace what is there meanwhile
  if (files.cloud.empty() && files.grid.empty() && files.octree.empty()) {
    lock.emplace(run);
    files = {run / "cloud.ply", run / "map", run / "map.bt"};
    for (const char* name : {"cloud.ply", "map.pgm", "map.yaml", "map.bt"})
      core::remove_partial_files(run / name);
  }
  const run::DenseOutcome outcome =
      run::make_dense_maps(run, config, files, lock ? &*lock : nullptr);
  print_figures(outcome.figures);
  if (outcome.no_grid && asks_for_grid)
    throw core::InputError(run.string() + ": " + *outcome.no_grid);
}

}  // namespace

void add_dense_command(CLI::App& app) {
  auto command = std::make_shared<DenseCommand>();
  CLI::App* sub = app.add_subcommand(
      "dense", "Fused cloud, occupancy grid and octree of a finished run with depth or stereo");
  sub->add_option("RUN", command->run, "folder that `samewhere run` wrote, or the map in it")
      ->required()
      ->transform(as_run_folder);
  sub->add_option("--cloud", command->files.cloud, "coloured points, PLY");
  sub->add_option("--grid", command->files.grid,
                  "plan for a map server: NAME.pgm and NAME.yaml are written");
  sub->add_option("--octree", command->files.octree, "free and occupied space, OctoMap's .bt");
  sub->add_option("--set", command->assignments,
                  "one setting other than in the run, e.g. dense.voxel_m=0.01; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  sub->footer(
      "Without --cloud, --grid and --octree all three go into RUN: cloud.ply, map.pgm with "
      "map.yaml, map.bt.\n"
      "Examples:\n"
      "  samewhere dense runs/kitchen\n"
      "  samewhere dense runs/kitchen --grid maps/kitchen --set dense.grid_cell_m=0.1");
  sub->callback([command] { execute(*command); });
}

}  // namespace samewhere::app
