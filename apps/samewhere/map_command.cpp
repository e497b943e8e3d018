#include <memory>
#include <string>

#include "commands.hpp"
#include "options.hpp"
#include "print.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/run/map_export.hpp>
#include <samewhere/scene/map_upgrade.hpp>

namespace samewhere::app {
namespace {

struct MapCommand {
  std::string file;
  std::string ply;
  std::string tum;
  std::string kitti;
  std::string g2o;
  int session = -1;
};

void add_info(CLI::App& map, const std::shared_ptr<MapCommand>& command) {
  map.add_subcommand("info", "Print the contents of the map and the settings of its run")
      ->callback([command] {
        scene::MapFile file = scene::MapFile::open(command->file);
        print_figures(run::figures_of_map(file.header(), file.load()));
      });
}

void add_export(CLI::App& map, const std::shared_ptr<MapCommand>& command) {
  CLI::App* sub = map.add_subcommand("export", "Export the map to PLY, TUM, KITTI or g2o");
  sub->add_option("--ply", command->ply, "landmarks as a point cloud");
  sub->add_option("--tum", command->tum, "measured frames: stamp tx ty tz qx qy qz qw");
  sub->add_option("--kitti", command->kitti, "the same frames, without stamps: 3 x 4 matrices");
  sub->add_option("--g2o", command->g2o, "pose graph of keyframes, odometry and loop closures");
  sub->add_option("--session", command->session,
                  "session whose frames --tum and --kitti export, 0 = the run that made the map; "
                  "required if the map holds several")
      ->check(CLI::Range(0, 1'000'000));
  sub->callback([command] {
    run::export_map(scene::MapFile::open(command->file).load(),
                    {command->ply, command->tum, command->kitti, command->g2o, command->session});
  });
}

void add_upgrade(CLI::App& map, const std::shared_ptr<MapCommand>& command) {
  map.add_subcommand("upgrade", "Rewrite a map file of the version before in the current one")
      ->callback([command] {
        core::print("{}: {}\n", command->file,
                    scene::upgrade_map_file(command->file) ? "upgraded"
                                                           : "is of the current version already");
      });
}

}  // namespace

void add_map_command(CLI::App& app) {
  auto command = std::make_shared<MapCommand>();
  CLI::App* sub = app.add_subcommand("map", "Inspect or export a map file");
  sub->add_option("FILE", command->file, "map.sw of a run, or the run's folder")
      ->required()
      ->transform(as_map_file);
  sub->require_subcommand(1);
  add_info(*sub, command);
  add_export(*sub, command);
  add_upgrade(*sub, command);
  sub->footer(
      "Examples:\n"
      "  samewhere map runs/demo/map.sw info\n"
      "  samewhere map runs/demo/map.sw export --ply points.ply --g2o graph.g2o\n"
      "  samewhere map office.sw export --tum second-run.tum --session 1");
}

}  // namespace samewhere::app
