#include <memory>
#include <string>

#include <fmt/format.h>

#include "commands.hpp"
#include "print.hpp"
#include <samewhere/core/terminal.hpp>
#include <samewhere/pipeline/run_folder.hpp>

namespace samewhere::app {

namespace {

struct EvalCommand {
  std::string folder;
  std::string walk;
  bool stages = false;
};

}  // namespace

void add_eval_command(CLI::App& app) {
  auto command = std::make_shared<EvalCommand>();
  CLI::App* sub =
      app.add_subcommand("eval", "Measure a finished run against the truth of its source");
  sub->add_option("RUN", command->folder, "folder that `samewhere run` or `samewhere loops` wrote")
      ->required();
  sub->add_option(
      "--walk", command->walk,
      "count accepted loops between floors; a list `image floor clip`, as the run's source");
  sub->add_flag("--stages", command->stages,
                "print where the time went instead: wall time and processor time of each stage");
  sub->footer(
      "Examples:\n"
      "  samewhere eval runs/twin-corridors\n"
      "  samewhere eval runs/walk.txt --walk tower/walk.txt\n"
      "  samewhere eval runs/twin-corridors --stages");
  sub->callback([command] {
    if (command->stages) {
      core::print("{}", report::as_text(pipeline::stages_of_folder(command->folder)));
      return;
    }
    print_figures(command->walk.empty() ? pipeline::evaluate_folder(command->folder)
                                        : pipeline::evaluate_walk(command->folder, command->walk));
  });
}

}  // namespace samewhere::app
