#include <algorithm>
#include <cmath>
#include <numeric>

#include <samewhere/core/errors.hpp>
#include <samewhere/optimize/edge_problem.hpp>
#include <samewhere/optimize/pose_graph.hpp>
#include <samewhere/optimize/scaled_edge.hpp>

namespace samewhere::optimize {
namespace {

constexpr double kGrowth = 1.4;  // of the control parameter from round to round
constexpr int kMaxRounds = 100;  // the parameter has grown by 4e14
constexpr double kReaches[] = {3000.0, 300.0, 30.0};  // of the limit, see call_back
constexpr int kMaxChecks = 10;                        // of sides changed after the rounds
// chi-square 99 %: 3 and 7 degrees of freedom for 6
constexpr double kPlanarShare = 11.34 / 16.81;
constexpr double kScaledShare = 18.48 / 16.81;

double limit_of(const PoseGraph& graph, const Config& config) {
  if (graph.is_planar) return kPlanarShare * config.loop_chi2;
  return (has_scales(graph) ? kScaledShare : 1.0) * config.loop_chi2;
}

// Graduated non-convexity over the loop edges of a graph.
class Graduation {
 public:
  Graduation(PoseGraph& graph, const Config& config)
      : graph_(graph), config_(config), problem_(graph, config), limit_(limit_of(graph, config)) {
    for (std::size_t i = 0; i < graph.edges.size(); ++i)
      if (graph.edges[i].is_loop) loops_.push_back(i);
  }

  PoseGraphSummary solve() {
    PoseGraphSummary summary = problem_.solve(config_.graph_iterations);
    const double worst = worst_chi2();
    if (worst > limit_) {
      graduate(limit_ / (2.0 * worst - limit_), summary);
      settle(summary);
      for (const double reach : kReaches) call_back(reach, summary);
    }
    summary.weights = problem_.weights();
    return summary;
  }

 private:
  struct State {
    std::vector<core::Rigid3> poses;
    std::vector<double> log_scales;
    std::vector<double> weights;
  };

  void go_on(int max_iterations, PoseGraphSummary& summary) {
    const PoseGraphSummary found = problem_.solve(max_iterations);
    summary.final_cost = found.final_cost;
    summary.num_iterations += found.num_iterations;
  }

  double worst_chi2() const {
    double worst = 0.0;
    for (const std::size_t loop : loops_)
      worst = std::max(worst, chi2_of(graph_, graph_.edges[loop]));
    return worst;
  }

  // What truncated least squares minimises.
  double truncated_cost() const {
    double cost = 0.0;
    for (const PoseEdge& edge : graph_.edges) {
      const double squared = chi2_of(graph_, edge);
      cost += edge.is_loop ? std::min(squared, limit_) : squared;
    }
    return cost;
  }

  // To truncated least squares, from where edges beyond 1 / control of the limit have no say: the
  // smaller, the more convex.
  void graduate(double control, PoseGraphSummary& summary) {
    for (int round = 0; round < kMaxRounds && !weigh(control); ++round, control *= kGrowth)
      go_on(config_.gnc_iterations, summary);
  }

  // Lies that were believed at first may have left a stretch of the path so far from where it is
  // that none of its loops fits any more. Once they are out, what fits no worse than `reach` times
  // the limit is asked again; kept if it makes the whole fit better.
  void call_back(double reach, PoseGraphSummary& summary) {
    const State before{graph_.world_from_node, graph_.log_scales, problem_.weights()};
    const double cost = truncated_cost();
    graduate(1.0 / reach, summary);
    settle(summary);
    if (truncated_cost() >= cost) go_back(before);
  }

  void go_back(const State& state) {
    graph_.world_from_node = state.poses;
    graph_.log_scales = state.log_scales;
    for (const std::size_t loop : loops_) problem_.weight(loop) = state.weights[loop];
    problem_.start_from_graph();
  }

  // Whether every weight is 0 or 1.
  bool weigh(double control) {
    bool is_settled = true;
    for (const std::size_t loop : loops_) {
      const double squared = chi2_of(graph_, graph_.edges[loop]);
      double& weight = problem_.weight(loop);
      if (squared >= (control + 1.0) / control * limit_) {
        weight = 0.0;
      } else if (squared <= control / (control + 1.0) * limit_) {
        weight = 1.0;
      } else {
        weight = std::sqrt(limit_ / squared * control * (control + 1.0)) - control;
        is_settled = false;
      }
    }
    return is_settled;
  }

  // Believes what fits and refuses what is bent, until no edge changes sides.
  void settle(PoseGraphSummary& summary) {
    for (int check = 0; check < kMaxChecks; ++check) {
      bool has_changed = false;
      for (const std::size_t loop : loops_) {
        const double weight = chi2_of(graph_, graph_.edges[loop]) <= limit_ ? 1.0 : 0.0;
        has_changed = has_changed || weight != problem_.weight(loop);
        problem_.weight(loop) = weight;
      }
      if (!has_changed && check > 0) return;
      go_on(config_.graph_iterations, summary);
    }
  }

  PoseGraph& graph_;
  const Config& config_;
  EdgeProblem problem_;
  double limit_;
  std::vector<std::size_t> loops_;
};

// What the losses left of an edge's weight, in a graph that is solved.
double weight_of(double chi2, const Config& config) {
  switch (config.loop_loss) {
    case LoopLoss::kHuber:
      return std::min(1.0, config.loop_huber / std::sqrt(std::max(chi2, 1e-300)));
    case LoopLoss::kDcs: {
      const double scale = std::min(1.0, 2.0 * config.loop_dcs / (config.loop_dcs + chi2));
      return scale * scale;
    }
    default:
      return 1.0;
  }
}

}  // namespace

core::Vector6d edge_error(const PoseEdge& edge, const core::Rigid3& world_from_a,
                          const core::Rigid3& world_from_b) {
  const core::Rigid3 a_from_b = inverse(world_from_a) * world_from_b;
  core::Vector6d error;
  error << a_from_b.translation - edge.a_from_b.translation,
      core::log_so3(edge.a_from_b.rotation.conjugate() * a_from_b.rotation);
  return error;
}

double chi2_of(const PoseGraph& graph, const PoseEdge& edge) {
  const auto a = static_cast<std::size_t>(edge.a);
  const auto b = static_cast<std::size_t>(edge.b);
  if (!has_scales(graph)) {
    const core::Vector6d error =
        edge_error(edge, graph.world_from_node[a], graph.world_from_node[b]);
    return error.dot(edge.information * error);
  }
  const Vector7d error = scaled_edge_error(edge, {graph.world_from_node[a], graph.log_scales[a]},
                                           {graph.world_from_node[b], graph.log_scales[b]});
  return error.head<6>().dot(edge.information * error.head<6>()) +
         edge.scale_information * error(6) * error(6);
}

EdgeJacobians edge_jacobians(const PoseEdge& edge, const core::Rigid3& world_from_a,
                             const core::Rigid3& world_from_b) {
  const Eigen::Matrix3d a_from_world = world_from_a.rotation.conjugate().toRotationMatrix();
  const Eigen::Matrix3d b_from_world = world_from_b.rotation.conjugate().toRotationMatrix();
  const Eigen::Vector3d offset = world_from_b.translation - world_from_a.translation;
  const Eigen::Vector3d rotation_error = edge_error(edge, world_from_a, world_from_b).tail<3>();
  const Eigen::Matrix3d rotation_by_b = right_jacobian_inverse(rotation_error) * b_from_world;

  EdgeJacobians jacobians{core::Matrix6d::Zero(), core::Matrix6d::Zero()};
  jacobians.by_a.topLeftCorner<3, 3>() = -a_from_world;
  jacobians.by_a.topRightCorner<3, 3>() = a_from_world * core::skew(offset);
  jacobians.by_a.bottomRightCorner<3, 3>() = -rotation_by_b;
  jacobians.by_b.topLeftCorner<3, 3>() = a_from_world;
  jacobians.by_b.bottomRightCorner<3, 3>() = rotation_by_b;
  return jacobians;
}

std::vector<int> parts_of(const PoseGraph& graph) {
  std::vector<int> parent(graph.world_from_node.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root_of = [&](int node) {
    while (parent[static_cast<std::size_t>(node)] != node) {
      int& above = parent[static_cast<std::size_t>(node)];
      above = parent[static_cast<std::size_t>(above)];
      node = above;
    }
    return node;
  };
  for (const PoseEdge& edge : graph.edges) {
    const auto [low, high] = std::minmax({root_of(edge.a), root_of(edge.b)});
    parent[static_cast<std::size_t>(high)] = low;
  }
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = root_of(static_cast<int>(i));
  return parent;
}

std::vector<int> held_nodes(const PoseGraph& graph) {
  const std::vector<int> part = parts_of(graph);
  std::vector<int> held = graph.fixed_nodes;
  std::vector<bool> is_held(part.size(), false);
  for (const int node : graph.fixed_nodes)
    is_held.at(static_cast<std::size_t>(part.at(static_cast<std::size_t>(node)))) = true;
  for (std::size_t i = 0; i < part.size(); ++i) {
    const auto lowest = static_cast<std::size_t>(part[i]);
    if (!is_held[lowest]) held.push_back(part[i]);
    is_held[lowest] = true;
  }
  return held;
}

PoseGraphSummary solve_pose_graph(PoseGraph& graph, const Config& config) {
  if (config.loop_loss == LoopLoss::kGnc) return Graduation(graph, config).solve();
  PoseGraphSummary summary = EdgeProblem(graph, config).solve(config.graph_iterations);
  for (const PoseEdge& edge : graph.edges)
    summary.weights.push_back(edge.is_loop ? weight_of(chi2_of(graph, edge), config) : 1.0);
  return summary;
}

}  // namespace samewhere::optimize
