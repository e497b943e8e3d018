#include <algorithm>
#include <cmath>
#include <utility>

#include <samewhere/optimize/graph_consistency.hpp>
#include <samewhere/optimize/robust_graph.hpp>

namespace samewhere::optimize {

RobustGraph::RobustGraph(PoseGraph& graph, const Config& config)
    : graph_(graph),
      config_(config),
      problem_(graph, config),
      limit_(chi2_limit(graph, config)),
      segment_costs_(graph.edges.size()) {
  for (std::size_t i = 0; i < graph.edges.size(); ++i)
    if (graph.edges[i].is_loop) loops_.push_back(i);
  std::stable_sort(loops_.begin(), loops_.end(), [&](std::size_t one, std::size_t other) {
    const auto later = [&](const PoseEdge& edge) { return std::max(edge.a, edge.b); };
    return later(graph.edges[one]) < later(graph.edges[other]);
  });
}

double RobustGraph::worst_chi2() const {
  double worst = 0.0;
  for (const std::size_t loop : loops_) worst = std::max(worst, chi2(loop));
  return worst;
}

double RobustGraph::truncated_cost() const {
  double cost = static_cast<double>(num_rejected_segments_) * limit_;
  for (std::size_t i = 0; i < graph_.edges.size(); ++i) {
    const PoseEdge& edge = graph_.edges[i];
    const double squared = chi2_of(graph_, edge);
    if (segment_costs_[i]) {
      cost += *segment_costs_[i];
    } else {
      cost += edge.is_loop ? std::min(squared, limit_) : squared;
    }
  }
  return cost;
}

void RobustGraph::optimize(int max_iterations) {
  PoseGraphSummary solved = problem_.solve(max_iterations);
  if (summary_) {
    summary_->num_iterations += solved.num_iterations;
  } else {
    summary_ = std::move(solved);
  }
}

void RobustGraph::anneal(double control) {
  const GncConfig& gnc = config_.gnc;
  for (int round = 0; round < gnc.max_rounds && !update_weights(control); ++round) {
    optimize(config_.gnc_iterations);
    control *= gnc.growth;
  }
}

// To those of truncated least squares (Yang et al., RA-L 2020). Whether all are 0 or 1.
bool RobustGraph::update_weights(double control) {
  bool has_converged = true;
  for (const std::size_t loop : loops_) {
    if (is_in_rejected_segment(loop)) continue;
    const double squared = chi2(loop);
    double& weight = problem_.weight(loop);
    if (squared >= (control + 1.0) / control * limit_) {
      weight = 0.0;
    } else if (squared <= control / (control + 1.0) * limit_) {
      weight = 1.0;
    } else {
      weight = std::sqrt(limit_ / squared * control * (control + 1.0)) - control;
      has_converged = false;
    }
  }
  return has_converged;
}

void RobustGraph::classify() {
  for (int check = 0; check < config_.gnc.max_checks; ++check) {
    bool has_changed = false;
    for (const std::size_t loop : loops_) {
      if (is_in_rejected_segment(loop)) continue;
      const double weight = fits(loop) ? 1.0 : 0.0;
      has_changed = has_changed || weight != problem_.weight(loop);
      problem_.weight(loop) = weight;
    }
    if (!has_changed && check > 0) return;
    optimize();
  }
}

void RobustGraph::retest_rejected() {
  double ratio = config_.gnc.retest_ratio;
  for (int i = 0; i < config_.gnc.num_retests; ++i, ratio /= config_.gnc.retest_step)
    retest_rejected(ratio);
}

void RobustGraph::retest_rejected(double ratio) {
  const State before = state();
  const double cost = truncated_cost();
  anneal(1.0 / ratio);
  classify();
  if (truncated_cost() >= cost) restore(before);
}

void RobustGraph::reject_segment(std::size_t begin, std::size_t end) {
  const double accepted_cost =
      degrees_of_freedom(graph_) + config_.loop_segments.loop_cost * limit_;
  for (std::size_t i = begin; i < end; ++i) {
    double& weight = problem_.weight(loops_[i]);
    segment_costs_[loops_[i]] = weight > 0.0 ? accepted_cost : limit_;
    weight = 0.0;
  }
  ++num_rejected_segments_;
  classify();
}

std::size_t RobustGraph::num_in_rejected_segments() const {
  return static_cast<std::size_t>(std::count_if(segment_costs_.begin(), segment_costs_.end(),
                                                [](const auto& cost) { return cost.has_value(); }));
}

RobustGraph::State RobustGraph::state() const {
  return {graph_.world_from_node, graph_.log_scales, problem_.weights(), segment_costs_,
          num_rejected_segments_};
}

void RobustGraph::restore(const State& state) {
  graph_.world_from_node = state.poses;
  graph_.log_scales = state.log_scales;
  segment_costs_ = state.segment_costs;
  num_rejected_segments_ = state.num_rejected_segments;
  for (const std::size_t loop : loops_) problem_.weight(loop) = state.weights[loop];
  problem_.start_from_graph();
}

PoseGraphSummary RobustGraph::summary() const {
  PoseGraphSummary summary = summary_.value_or(PoseGraphSummary{});
  summary.weights = problem_.weights();
  summary.robust_cost = 0.5 * truncated_cost();
  summary.final_cost = 0.0;
  for (std::size_t i = 0; i < graph_.edges.size(); ++i)
    summary.final_cost += 0.5 * summary.weights[i] * chi2_of(graph_, graph_.edges[i]);
  return summary;
}

}  // namespace samewhere::optimize
