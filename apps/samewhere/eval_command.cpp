#include <memory>
#include <string>

#include <fmt/format.h>

#include "commands.hpp"
#include "options.hpp"
#include "print.hpp"
#include <samewhere/core/terminal.hpp>
#include <samewhere/run/run_folder.hpp>

namespace samewhere::app {

namespace {

struct EvalCommand {
  std::string folder;
  std::string walk;
  std::string truth;
  bool stages = false;
  FigureOptions figures;
};

}  // namespace

void add_eval_command(CLI::App& app) {
  auto command = std::make_shared<EvalCommand>();
  CLI::App* sub =
      app.add_subcommand("eval", "Evaluate a finished run against the ground truth of its source");
  sub->add_option("RUN", command->folder,
                  "folder that `samewhere run` or `samewhere loops` wrote, or the map in it")
      ->required()
      ->transform(as_run_folder);
  CLI::Option* truth = sub->add_option("--truth", command->truth,
                                       "ground truth trajectory, TUM format (stamp tx ty tz qx qy "
                                       "qz qw), if the recording has none");
  CLI::Option* walk = sub->add_option(
      "--walk", command->walk,
      "count accepted loops between floors, by a list `image floor [clip]` of the run's source");
  walk->excludes(truth);
  sub->add_flag("--stages", command->stages, "print wall time and CPU time of each stage instead")
      ->excludes(truth)
      ->excludes(walk);
  add_json_option(*sub, command->figures);
  sub->footer(
      "Examples:\n"
      "  samewhere eval runs/twin-corridors\n"
      "  samewhere eval runs/office --truth mocap.tum\n"
      "  samewhere eval runs/office --json - | jq '.figures[\"ATE RMSE (median, "
      "max)\"].numbers[0]'\n"
      "  samewhere eval runs/walk.txt --walk tower/walk.txt\n"
      "  samewhere eval runs/twin-corridors --stages");
  sub->callback([command] {
    if (command->stages) {
      core::print("{}", report::as_text(run::stages_of_folder(command->folder)));
      return;
    }
    const auto figures = command->walk.empty()
                             ? run::evaluate_folder(command->folder, command->truth)
                             : run::evaluate_walk(command->folder, command->walk);
    if (command->figures.prints_text()) print_figures(figures);
    write_json(command->folder, figures, command->figures);
  });
}

}  // namespace samewhere::app
