// graphs: convergence, error and time of the pose graph solver on the usual kinds of graphs
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "graph_world.hpp"
#include "other_graph_solver.hpp"
#include "program.hpp"
#include <samewhere/core/timing.hpp>

namespace samewhere::bench {
namespace {

using Solve = std::function<void(optimize::PoseGraph&)>;

// Half of the sum of squared errors of all edges: the same formula for every solver.
double cost_of(const optimize::PoseGraph& graph) {
  double sum = 0.0;
  for (const auto& edge : graph.edges) sum += chi2_of(graph, edge);
  return 0.5 * sum;
}

std::vector<std::string> row(const GraphWorld& world, const std::string& graph,
                             const std::string& solver, const Solve& solve) {
  GraphWorld solved = world;
  core::Timings timings;
  {
    const core::ScopedTimer timer(timings, "solve");
    solve(solved.graph);
  }
  GraphWorld truth = world;
  truth.graph.world_from_node = world.world_from_node;
  return {graph,
          std::to_string(world.graph.world_from_node.size()),
          std::to_string(world.graph.edges.size()),
          solver,
          fmt::format("{:.2f}", timings.durations_ms().at("solve").front() / 1e3),
          fmt::format("{:.4g}", cost_of(world.graph)),
          fmt::format("{:.4f}", cost_of(solved.graph)),
          fmt::format("{:.4f}", cost_of(truth.graph)),
          fmt::format("{:.4f}", ate_m(solved))};
}

void add_rows(const GraphWorld& world, const std::string& name, Table& table) {
  const auto by = [](optimize::LoopLoss loss) {
    return [loss](optimize::PoseGraph& graph) { solve_pose_graph(graph, {.loop_loss = loss}); };
  };
  table.rows.push_back(row(world, name, "least squares", by(optimize::LoopLoss::kLeastSquares)));
  table.rows.push_back(row(world, name, "gnc (default)", by(optimize::LoopLoss::kGnc)));
  if (has_other_graph_solver())
    table.rows.push_back(row(world, name, "mrpt, least squares", solve_with_other));
}

void measure(const std::string& csv_file) {
  Table table{{"graph", "poses", "edges", "solver", "seconds", "cost before", "cost after",
               "cost of the truth", "ATE m"},
              {}};
  for (const auto kind :
       {GraphKind::kSphere, GraphKind::kTorus, GraphKind::kGrid, GraphKind::kTown}) {
    const std::string name(name_of(kind));
    const GraphWorld world = make_graph(kind, {}, 1000);
    add_rows(world, name, table);
    // initialized by noisy odometry alone; the best cost is that of the noise
    add_rows(make_graph(kind, {.sigma_m = 0.01, .sigma_rad = 0.005}, 1000), name + ", little noise",
             table);
    add_rows(with_exact_edges(world), name + ", exact edges", table);
  }
  publish(table, csv_file);
}

std::function<void()> set_up(CLI::App& app) {
  const auto csv_file = std::make_shared<std::string>();
  app.name("graphs");
  app.description("Time and cost of solving synthetic pose graphs, on one core.");
  app.add_option("--csv", *csv_file, "write the table to this file, too");
  return [csv_file] { measure(*csv_file); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
