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
      app.add_subcommand("optimize", "Optimize a pose graph robustly against outlier loops");
  sub->add_option("GRAPH", command->file,
                  "a g2o file with VERTEX_SE3:QUAT and EDGE_SE3:QUAT, or VERTEX_SE2 and EDGE_SE2")
      ->required();
  add_config_options(*sub, command->config);
  sub->add_option("--out", command->out, "optimized graph, g2o file");
  sub->add_option("--loops", command->loops, "all loops with squared error and final weight, CSV");
  sub->add_option("--svg", command->svg, "plot of the graph before and after");
  sub->callback([command] {
    print_figures(run::optimize_graph(command->file, load(command->config).optimize,
                                      {command->out, command->loops, command->svg}));
  });
  sub->footer(
      "The first edge from a vertex to the next vertex of the file is odometry; all others are "
      "loops, which are rejected as outliers if inconsistent. Landmarks are left out and counted. "
      "Without VERTEX lines the poses are initialized along the edges.\n"
      "Initial values: the poses of the file, then odometry, then a chordal relaxation, until a "
      "solution explains the measurements; 'converged no': the iterations ran out.\n"
      "cost is half of the squared errors, with the angle as the error of a rotation; chi2 is that "
      "of "
      "g2o, which takes twice the sine of half the angle.\n"
      "Examples:\n"
      "  samewhere optimize graph.g2o --out solved.g2o --svg graph.svg\n"
      "  samewhere optimize graph.g2o --set optimize.loop_loss=least_squares\n"
      "  samewhere map runs/demo/map.sw export --g2o graph.g2o\n"
      "  samewhere optimize graph.g2o --set optimize.loop_loss=huber --loops loops.csv");
}

}  // namespace samewhere::app
