// injected_loops: how accurate is a pose graph with false loop closures, under every loss?
#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "graph_world.hpp"
#include "program.hpp"
#include <samewhere/core/median.hpp>
#include <samewhere/core/progress.hpp>

namespace samewhere::bench {
namespace {

struct Loss {
  std::string name;
  optimize::LoopLoss loss;
};

const Loss kLosses[] = {{"least squares", optimize::LoopLoss::kLeastSquares},
                        {"Huber", optimize::LoopLoss::kHuber},
                        {"dynamic covariance scaling", optimize::LoopLoss::kDcs},
                        {"gnc, as published", optimize::LoopLoss::kGncEach},
                        {"gnc (default)", optimize::LoopLoss::kGnc}};

struct Findings {
  std::vector<double> ate_m;
  int num_false = 0;
  int num_accepted_false = 0;
  int num_true = 0;
  int num_rejected_true = 0;
};

void solve(GraphWorld world, optimize::LoopLoss loss, Findings& findings) {
  const optimize::PoseGraphSummary summary = solve_pose_graph(world.graph, {.loop_loss = loss});
  findings.ate_m.push_back(ate_m(world));
  for (std::size_t i = 0; i < world.is_outlier.size(); ++i) {
    if (!world.graph.edges[i].is_loop) continue;
    const bool is_accepted = summary.weights[i] >= 0.5;
    findings.num_false += world.is_outlier[i];
    findings.num_true += !world.is_outlier[i];
    findings.num_accepted_false += world.is_outlier[i] && is_accepted;
    findings.num_rejected_true += !world.is_outlier[i] && !is_accepted;
  }
}

// The graph without its outlier edges, initialized at the true poses. Its solution is the best fit;
// from composed odometry least squares may end in a local minimum.
GraphWorld without_outliers(const GraphWorld& world) {
  GraphWorld rest = world;
  rest.graph.world_from_node = world.world_from_node;
  rest.graph.edges.clear();
  for (std::size_t i = 0; i < world.is_outlier.size(); ++i)
    if (!world.is_outlier[i]) rest.graph.edges.push_back(world.graph.edges[i]);
  rest.is_outlier.assign(rest.graph.edges.size(), false);
  return rest;
}

struct Settings {
  int num_seeds = 3;
  int first_seed = 1001;
  std::string csv_file;
};

using AddOutliers = void (*)(GraphWorld&, double, std::uint64_t);

struct Case {
  GraphKind kind;
  std::string outliers_name;
  AddOutliers add_outliers;
  double share;
  GraphNoise noise = {};
};

// Of accurate odometry: 0.3 m and 0.05 rad after 100 m.
constexpr GraphNoise kLittleNoise = {0.01, 0.005};

std::string name_of(const Case& one) {
  const bool is_little = one.noise.sigma_m == kLittleNoise.sigma_m;
  return fmt::format("{}{}", name_of(one.kind), is_little ? ", little noise" : "");
}

// One for each seed.
std::vector<double> ratios_of(const std::vector<double>& ate_m, const std::vector<double>& best_m) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < ate_m.size(); ++i) ratios.push_back(ate_m[i] / best_m[i]);
  return ratios;
}

double worst_of(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

void add_rows(const Case& one, const Settings& settings, Table& table) {
  std::vector<Findings> by_loss(std::size(kLosses));
  Findings best;
  for (int seed = settings.first_seed; seed < settings.first_seed + settings.num_seeds; ++seed) {
    GraphWorld world = make_graph(one.kind, one.noise, static_cast<std::uint64_t>(seed));
    one.add_outliers(world, one.share, static_cast<std::uint64_t>(seed));
    solve(without_outliers(world), optimize::LoopLoss::kLeastSquares, best);
    for (std::size_t i = 0; i < by_loss.size(); ++i) solve(world, kLosses[i].loss, by_loss[i]);
  }
  for (std::size_t i = 0; i < by_loss.size(); ++i) {
    const Findings& found = by_loss[i];
    const std::vector<double> ratios = ratios_of(found.ate_m, best.ate_m);
    table.rows.push_back({name_of(one), one.outliers_name, fmt::format("{:.0f} %", 100 * one.share),
                          kLosses[i].name, fmt::format("{:.3f}", *core::median(best.ate_m)),
                          fmt::format("{:.3f}", *core::median(found.ate_m)),
                          fmt::format("{:.3f}", worst_of(found.ate_m)),
                          fmt::format("{:.2f}", *core::median(ratios)),
                          fmt::format("{:.2f}", worst_of(ratios)),
                          fmt::format("{} of {}", found.num_accepted_false, found.num_false),
                          fmt::format("{} of {}", found.num_rejected_true, found.num_true)});
  }
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const auto kind : {GraphKind::kHalls, GraphKind::kGrid}) {
    all.push_back({kind, "none", add_random_outliers, 0.0});
    for (const double share : {0.01, 0.05, 0.2, 0.5})
      all.push_back({kind, "random", add_random_outliers, share});
    for (const double share : {0.01, 0.05, 0.2, 0.5})
      all.push_back({kind, "consistent", add_consistent_outliers, share});
    for (const double share : {0.01, 0.05, 0.2, 0.5})
      all.push_back({kind, "consistent", add_consistent_outliers, share, kLittleNoise});
  }
  return all;
}

void measure(const Settings& settings) {
  Table table{{"graph", "false loops", "share", "loss", "ATE m without false loops", "ATE m",
               "worst", "ratio", "worst ratio", "false loops accepted", "true rejected"},
              {}};
  const std::vector<Case> all = cases();
  core::Progress progress("cases", static_cast<int>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) {
    add_rows(all[i], settings, table);
    progress.update(static_cast<int>(i) + 1);
  }
  progress.finish();
  publish(table, settings.csv_file);
}

std::function<void()> set_up(CLI::App& app) {
  const auto settings = std::make_shared<Settings>();
  app.name("injected_loops");
  app.description("ATE of pose graphs with false loop closures, under every loss.");
  app.add_option("--seeds", settings->num_seeds, "graphs of each kind")->check(CLI::Range(1, 100));
  app.add_option("--first-seed", settings->first_seed, "of the first graph");
  app.add_option("--csv", settings->csv_file, "write the table to this file, too");
  return [settings] { measure(*settings); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
