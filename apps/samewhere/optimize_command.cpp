#include <memory>
#include <string>

#include "commands.hpp"
#include "options.hpp"
#include "print.hpp"
#include <samewhere/run/graph_file.hpp>

namespace samewhere::app {
namespace {

struct OptimizeCommand {
  std::string file;
  ConfigOptions config;
  std::string out;
  std::string loops;
  std::string svg;
};

}  // namespace

void add_optimize_command(CLI::App& app) {
  auto command = std::make_shared<OptimizeCommand>();
  CLI::App* sub =
      app.add_subcommand("optimize", "Solve a pose graph, some of whose loops may be wrong");
  sub->add_option("GRAPH", command->file,
                  "a g2o file with VERTEX_SE3:QUAT and EDGE_SE3:QUAT, or VERTEX_SE2 and EDGE_SE2")
      ->required();
  add_config_options(*sub, command->config);
  sub->add_option("--out", command->out, "the solved graph, a g2o file again");
  sub->add_option("--loops", command->loops, "every loop and whether it was believed, CSV");
  sub->add_option("--svg", command->svg, "a picture of the graph before and after");
  sub->callback([command] {
    print_figures(run::optimize_graph(command->file, load(command->config).optimize,
                                      {command->out, command->loops, command->svg}));
  });
  sub->footer(
      "The first edge from a number to the next one that the file has is odometry and is believed; "
      "every other is a loop, which is refused if it does not fit. Landmarks are left out and "
      "counted. Without VERTEX lines the poses are laid out along the edges.\n"
      "Solved from the poses of the file, from odometry and from a chordal relaxation, until one "
      "explains the measurements; 'converged no' means that the iterations ran out.\n"
      "cost is half of the squared errors with the angle of a rotation as its error, chi2 is g2o's "
      "sum, which takes twice the sine of half the angle; the same in the plane.\n"
      "Examples:\n"
      "  samewhere optimize graph.g2o --out solved.g2o --svg graph.svg\n"
      "  samewhere optimize graph.g2o --set optimize.loop_loss=least_squares\n"
      "  samewhere map runs/demo/map.sw export --g2o graph.g2o\n"
      "  samewhere optimize graph.g2o --set optimize.loop_loss=huber --loops loops.csv");
}

}  // namespace samewhere::app
