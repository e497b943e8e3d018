#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <samewhere/optimize/chordal.hpp>
#include <samewhere/optimize/edge_problem.hpp>
#include <samewhere/optimize/graduated_non_convexity.hpp>
#include <samewhere/optimize/graph_consistency.hpp>
#include <samewhere/optimize/initial_guesses.hpp>
#include <samewhere/optimize/spanning_tree.hpp>

namespace samewhere::optimize {
namespace {

constexpr double kSameCost = 1e-6;  // relative: rounding

double chi2_of_all(const PoseGraph& graph) {
  double sum = 0.0;
  for (const PoseEdge& edge : graph.edges) sum += chi2_of(graph, edge);
  return sum;
}

struct Guess {
  PoseGraph graph;
  InitialGuess kind = InitialGuess::kGiven;
  double chi2 = 0.0;
};

// Guesses that differ, the least squared error first.
std::vector<Guess> guesses_for(const PoseGraph& graph) {
  std::vector<Guess> guesses = {{graph, InitialGuess::kGiven}};
  if (!has_scales(graph)) {
    guesses.push_back({graph, InitialGuess::kChordal});
    place_by_chordal_relaxation(guesses.back().graph);
  }
  guesses.push_back({graph, InitialGuess::kOdometry});
  place_by_spanning_tree(guesses.back().graph);
  for (Guess& guess : guesses) guess.chi2 = chi2_of_all(guess.graph);
  std::erase_if(guesses, [&](const Guess& guess) {
    return guess.kind != InitialGuess::kGiven &&
           !(std::abs(guess.chi2 - guesses.front().chi2) > kSameCost * guesses.front().chi2);
  });
  std::stable_sort(guesses.begin(), guesses.end(),
                   [](const Guess& one, const Guess& other) { return one.chi2 < other.chi2; });
  return guesses;
}

// Solves under the weights found, to convergence or the limit of iterations.
void finish(PoseGraph& graph, const Config& config, PoseGraphSummary& summary) {
  EdgeProblem problem(graph, config);
  for (std::size_t i = 0; i < graph.edges.size(); ++i) problem.weight(i) = summary.weights[i];
  const bool has_weights =
      config.loop_loss == LoopLoss::kGnc || config.loop_loss == LoopLoss::kGncEach;
  if (!has_weights)
    for (std::size_t i = 0; i < graph.edges.size(); ++i) problem.weight(i) = 1.0;
  const PoseGraphSummary end =
      problem.solve(config.initial_guesses.final_factor * config.graph_iterations);
  summary.num_iterations += end.num_iterations;
  summary.has_converged = end.has_converged;
  summary.robust_cost += end.final_cost - end.initial_cost;
  summary.final_cost += end.final_cost - end.initial_cost;
}

PoseGraphSummary solve_one(PoseGraph& graph, const Config& config) {
  if (config.loop_loss == LoopLoss::kGnc)
    if (auto summary = GraduatedNonConvexity(graph, config).solve_if_consistent())
      return *std::move(summary);
  return solve_pose_graph(graph, config);
}

// Whether noise explains the rest, so that no other guess can end better; of a large graph, where
// each guess may take a minute, whether most loops are accepted.
bool is_good_enough(const PoseGraph& graph, const Config& config, const PoseGraphSummary& summary) {
  const auto num_rejected = static_cast<std::size_t>(
      std::count_if(summary.weights.begin(), summary.weights.end(),
                    [](double weight) { return weight < kMinInlierWeight; }));
  if (is_consistent(graph, config, 2.0 * summary.robust_cost, num_rejected)) return true;
  const auto num_loops = static_cast<std::size_t>(std::count_if(
      graph.edges.begin(), graph.edges.end(), [](const PoseEdge& edge) { return edge.is_loop; }));
  const auto large_graph_nodes = static_cast<std::size_t>(config.initial_guesses.large_graph_nodes);
  return graph.world_from_node.size() > large_graph_nodes && num_rejected > 0 &&
         2 * num_rejected < num_loops;
}

}  // namespace

std::string_view name_of(InitialGuess guess) {
  constexpr std::string_view kNames[] = {"poses of the file", "odometry", "chordal relaxation"};
  return kNames[static_cast<int>(guess)];
}

BestOfGuesses solve_from_initial_guesses(PoseGraph& graph, const Config& config) {
  if (graph.edges.empty() || graph.world_from_node.empty())
    return {solve_pose_graph(graph, config), InitialGuess::kGiven};
  const std::vector<int> held = held_nodes(graph);
  const std::vector<core::Rigid3> before = graph.world_from_node;
  const Eigen::Vector3d origin = before[static_cast<std::size_t>(held.front())].translation;
  for (core::Rigid3& pose : graph.world_from_node) pose.translation -= origin;

  BestOfGuesses best;
  const double initial_cost = 0.5 * chi2_of_all(graph);
  bool is_first = true;
  for (Guess& guess : guesses_for(graph)) {
    PoseGraphSummary summary = solve_one(guess.graph, config);
    const bool is_done = is_good_enough(guess.graph, config, summary);
    if (is_first || summary.robust_cost < (1.0 - kSameCost) * best.solution.robust_cost) {
      graph.world_from_node = std::move(guess.graph.world_from_node);
      graph.log_scales = std::move(guess.graph.log_scales);
      best = {std::move(summary), guess.kind};
    }
    is_first = false;
    if (is_done) break;
  }
  finish(graph, config, best.solution);
  best.solution.initial_cost = initial_cost;
  for (core::Rigid3& pose : graph.world_from_node) pose.translation += origin;
  for (const int node : held)
    graph.world_from_node[static_cast<std::size_t>(node)] = before[static_cast<std::size_t>(node)];
  return best;
}

}  // namespace samewhere::optimize
