#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <samewhere/optimize/chordal.hpp>
#include <samewhere/optimize/edge_problem.hpp>
#include <samewhere/optimize/graduated_non_convexity.hpp>
#include <samewhere/optimize/initial_guesses.hpp>
#include <samewhere/optimize/spanning_tree.hpp>

namespace samewhere::optimize {
namespace {

constexpr double kLess = 1.0 - 1e-6;  // of a cost, for another start to be the better one
constexpr std::size_t kManyPoses = 2000;
constexpr double kBelieved = 0.5;   // of a weight
constexpr int kMoreIterations = 4;  // of graph_iterations, to the end
constexpr double kSameCost = 1e-6;  // relative

double chi2_of_all(const PoseGraph& graph) {
  double sum = 0.0;
  for (const PoseEdge& edge : graph.edges) sum += chi2_of(graph, edge);
  return sum;
}

struct Start {
  PoseGraph graph;
  GraphStart kind = GraphStart::kGiven;
  double chi2 = 0.0;
};

// Those that differ, the least squared errors first.
std::vector<Start> starts_of(const PoseGraph& graph) {
  std::vector<Start> starts = {{graph, GraphStart::kGiven}};
  if (!has_scales(graph)) {
    starts.push_back({graph, GraphStart::kChordal});
    place_by_chordal_relaxation(starts.back().graph);
  }
  starts.push_back({graph, GraphStart::kOdometry});
  lay_out(starts.back().graph);
  for (Start& start : starts) start.chi2 = chi2_of_all(start.graph);
  std::erase_if(starts, [&](const Start& start) {
    return start.kind != GraphStart::kGiven &&
           !(std::abs(start.chi2 - starts.front().chi2) > kSameCost * starts.front().chi2);
  });
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& one, const Start& other) { return one.chi2 < other.chi2; });
  return starts;
}

// Under the weights found, until nothing changes or the iterations run out.
void finish(PoseGraph& graph, const Config& config, PoseGraphSummary& summary) {
  EdgeProblem problem(graph, config);
  for (std::size_t i = 0; i < graph.edges.size(); ++i) problem.weight(i) = summary.weights[i];
  const bool has_weights =
      config.loop_loss == LoopLoss::kGnc || config.loop_loss == LoopLoss::kGncEach;
  if (!has_weights)
    for (std::size_t i = 0; i < graph.edges.size(); ++i) problem.weight(i) = 1.0;
  const PoseGraphSummary end = problem.solve(kMoreIterations * config.graph_iterations);
  summary.num_iterations += end.num_iterations;
  summary.has_converged = end.has_converged;
  summary.robust_cost += end.final_cost - end.initial_cost;
  summary.final_cost += end.final_cost - end.initial_cost;
}

PoseGraphSummary solve_one(PoseGraph& graph, const Config& config) {
  if (config.loop_loss == LoopLoss::kGnc)
    if (auto summary = Graduation(graph, config).solve_if_consistent()) return *std::move(summary);
  return solve_pose_graph(graph, config);
}

// Whether noise explains what is left, so that no other start can end better; of a large graph,
// where each start may take a minute, whether most loops are believed.
bool is_good_enough(const PoseGraph& graph, const PoseGraphSummary& summary) {
  const auto num_refused =
      static_cast<std::size_t>(std::count_if(summary.weights.begin(), summary.weights.end(),
                                             [](double weight) { return weight < kBelieved; }));
  if (is_consistent(graph, 2.0 * summary.robust_cost, num_refused)) return true;
  const auto num_loops = static_cast<std::size_t>(std::count_if(
      graph.edges.begin(), graph.edges.end(), [](const PoseEdge& edge) { return edge.is_loop; }));
  return graph.world_from_node.size() > kManyPoses && num_refused > 0 &&
         2 * num_refused < num_loops;
}

}  // namespace

std::string_view name_of(GraphStart start) {
  constexpr std::string_view kNames[] = {"poses of the file", "odometry", "chordal relaxation"};
  return kNames[static_cast<int>(start)];
}

AnyStartSummary solve_from_any_start(PoseGraph& graph, const Config& config) {
  if (graph.edges.empty() || graph.world_from_node.empty())
    return {solve_pose_graph(graph, config), GraphStart::kGiven};
  const std::vector<int> held = held_nodes(graph);
  const std::vector<core::Rigid3> before = graph.world_from_node;
  const Eigen::Vector3d origin = before[static_cast<std::size_t>(held.front())].translation;
  for (core::Rigid3& pose : graph.world_from_node) pose.translation -= origin;

  AnyStartSummary best;
  const double initial_cost = 0.5 * chi2_of_all(graph);
  bool is_first = true;
  for (Start& start : starts_of(graph)) {
    PoseGraphSummary summary = solve_one(start.graph, config);
    const bool is_over = is_good_enough(start.graph, summary);
    if (is_first || summary.robust_cost < kLess * best.solution.robust_cost) {
      graph.world_from_node = std::move(start.graph.world_from_node);
      graph.log_scales = std::move(start.graph.log_scales);
      best = {std::move(summary), start.kind};
    }
    is_first = false;
    if (is_over) break;
  }
  finish(graph, config, best.solution);
  best.solution.initial_cost = initial_cost;
  for (core::Rigid3& pose : graph.world_from_node) pose.translation += origin;
  for (const int node : held)
    graph.world_from_node[static_cast<std::size_t>(node)] = before[static_cast<std::size_t>(node)];
  return best;
}

}  // namespace samewhere::optimize
