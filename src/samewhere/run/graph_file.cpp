#include <algorithm>
#include <chrono>
#include <set>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/file.hpp>
#include <samewhere/optimize/any_start.hpp>
#include <samewhere/optimize/g2o_file.hpp>
#include <samewhere/report/graph_plan.hpp>
#include <samewhere/report/table.hpp>
#include <samewhere/run/graph_file.hpp>

namespace samewhere::run {
namespace {

constexpr double kBelieved = 0.5;  // of a loop's weight

std::size_t num_loops(const optimize::PoseGraph& graph) {
  return static_cast<std::size_t>(std::count_if(graph.edges.begin(), graph.edges.end(),
                                                [](const auto& edge) { return edge.is_loop; }));
}

std::size_t num_parts(const optimize::PoseGraph& graph) {
  const std::vector<int> parts = optimize::parts_of(graph);
  return std::set<int>(parts.begin(), parts.end()).size();
}

// Nothing says where they are.
std::size_t num_alone(const optimize::PoseGraph& graph) {
  const std::vector<bool> has_edge = nodes_with_edges(graph);
  return static_cast<std::size_t>(std::count(has_edge.begin(), has_edge.end(), false));
}

// A graph that was solved, and how.
struct Solved {
  const optimize::PoseGraph& graph;
  const optimize::AnyStartSummary& summary;
  double g2o_chi2_before = 0.0;
  double seconds = 0.0;
};

std::vector<report::Figure> figures_of_graph(const optimize::G2oGraph& file) {
  const optimize::PoseGraph& graph = file.graph;
  const std::size_t loops = num_loops(graph);
  std::vector<report::Figure> figures = {
      {"poses", fmt::format("{} in {}", graph.world_from_node.size(),
                            graph.is_planar ? "the plane" : "space")},
      {"edges", fmt::format("{}: {} from a pose to the next, {} loops", graph.edges.size(),
                            graph.edges.size() - loops, loops)}};
  if (file.is_without_vertices)
    figures.push_back({"vertices", "none in the file; poses laid out along the edges"});
  if (const std::size_t alone = num_alone(graph); alone > 0)
    figures.push_back({"poses without an edge", fmt::format("{}, left out", alone)});
  if (const std::size_t parts = num_parts(graph) - num_alone(graph); parts > 1)
    figures.push_back({"parts", fmt::format("{}, each solved by itself", parts)});
  for (const auto& [type, count] : file.skipped)
    figures.push_back({"lines left out", fmt::format("{} of unknown type {}", count, type)});
  return figures;
}

// Of the edges believed, or of all of them, with g2o's error.
double g2o_chi2(const optimize::PoseGraph& graph, const std::vector<double>& weights) {
  double sum = 0.0;
  for (std::size_t i = 0; i < graph.edges.size(); ++i)
    sum += (weights.empty() ? 1.0 : weights[i]) * g2o_chi2_of(graph, graph.edges[i]);
  return sum;
}

std::vector<report::Figure> figures_of_solution(const Solved& solved) {
  const optimize::PoseGraphSummary& summary = solved.summary.solution;
  std::size_t refused = 0;
  for (const double weight : summary.weights) refused += weight < kBelieved ? 1 : 0;
  return {{"cost before / after",
           fmt::format("{:.6g} / {:.6g} (half of the squared errors; before: of all edges, after: "
                       "of those believed)",
                       summary.initial_cost, summary.final_cost)},
          {"chi2 before / after",
           fmt::format("{:.6g} / {:.6g} (as g2o computes it, of the same edges)",
                       solved.g2o_chi2_before, g2o_chi2(solved.graph, summary.weights))},
          {"loops believed / refused",
           fmt::format("{} / {}", num_loops(solved.graph) - refused, refused)},
          {"started from", std::string(name_of(solved.summary.start))},
          {"iterations", std::to_string(summary.num_iterations)},
          {"converged", summary.has_converged ? "yes" : "no, the iterations ran out"},
          {"time", fmt::format("{:.2f} s", solved.seconds)}};
}

std::string loops_csv(const optimize::G2oGraph& file, const std::vector<double>& weights) {
  report::Table table{{"a", "b", "squared_error", "weight"}, {}};
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const optimize::PoseEdge& edge = file.graph.edges[i];
    if (!edge.is_loop) continue;
    table.rows.push_back({std::to_string(file.names[static_cast<std::size_t>(edge.a)]),
                          std::to_string(file.names[static_cast<std::size_t>(edge.b)]),
                          fmt::format("{:.6g}", chi2_of(file.graph, edge)),
                          fmt::format("{:.4g}", weights[i])});
  }
  return report::as_csv(table);
}

report::GraphRecord record_of(const optimize::PoseGraph& graph, std::vector<core::Rigid3> before,
                              const std::vector<double>& weights) {
  report::GraphRecord record{.before = std::move(before), .after = graph.world_from_node};
  record.is_planar = graph.is_planar;
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const optimize::PoseEdge& edge = graph.edges[i];
    auto& pairs = !edge.is_loop             ? record.path
                  : weights[i] >= kBelieved ? record.believed
                                            : record.refused;
    pairs.emplace_back(edge.a, edge.b);
  }
  return record;
}

}  // namespace

std::vector<report::Figure> optimize_graph(const std::filesystem::path& file,
                                           const optimize::Config& config,
                                           const GraphExports& wanted) {
  optimize::G2oGraph read = optimize::read_g2o(file);
  std::vector<core::Rigid3> before = read.graph.world_from_node;
  const double g2o_chi2_before = g2o_chi2(read.graph, {});
  const auto start = std::chrono::steady_clock::now();
  const optimize::AnyStartSummary solved = solve_from_any_start(read.graph, config);
  const optimize::PoseGraphSummary& summary = solved.solution;
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  if (!summary.has_converged) {
    spdlog::warn(
        "{}: not converged after {} iterations; expected convergence, try --set "
        "optimize.graph_iterations={}",
        file.string(), summary.num_iterations, std::min(1000, 4 * config.graph_iterations));
  }

  if (!wanted.g2o.empty()) core::write_file(wanted.g2o, g2o_text(read.graph, read.names));
  if (!wanted.loops.empty()) core::write_file(wanted.loops, loops_csv(read, summary.weights));
  if (!wanted.svg.empty()) {
    report::GraphRecord record = record_of(read.graph, std::move(before), summary.weights);
    record.title = file.filename().string();
    core::write_file(wanted.svg, report::graph_plan_svg(record));
  }
  std::vector<report::Figure> figures = figures_of_graph(read);
  for (auto& figure : figures_of_solution({read.graph, solved, g2o_chi2_before, seconds.count()}))
    figures.push_back(std::move(figure));
  return figures;
}

}  // namespace samewhere::run
