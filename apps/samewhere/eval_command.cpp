#include <memory>
#include <string>

#include "commands.hpp"
#include "print.hpp"
#include <samewhere/pipeline/run_folder.hpp>

namespace samewhere::app {

void add_eval_command(CLI::App& app) {
  auto folder = std::make_shared<std::string>();
  CLI::App* sub =
      app.add_subcommand("eval", "Measure a finished run against the truth of its source");
  sub->add_option("RUN", *folder, "folder that `samewhere run` or `samewhere loops` wrote")
      ->required();
  sub->footer("Example:\n  samewhere eval runs/office-loop");
  sub->callback([folder] { print_figures(pipeline::evaluate_folder(*folder)); });
}

}  // namespace samewhere::app
