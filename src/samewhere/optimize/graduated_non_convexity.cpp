#include <algorithm>
#include <cmath>
#include <utility>

#include <samewhere/optimize/consistent_loops.hpp>
#include <samewhere/optimize/graduated_non_convexity.hpp>

namespace samewhere::optimize {
namespace {

constexpr double kGrowth = 1.4;  // of the control parameter from round to round
constexpr int kMaxRounds = 100;  // the parameter has grown by 4e14
constexpr double kReaches[] = {3000.0, 300.0, 30.0};  // of the limit, see call_back
constexpr double kReachOfDoubted = 10.0;              // of the limit, see fit_with_doubted
constexpr double kSpeaksFor = 0.5;  // bent so much less beside another, a loop says the same
constexpr std::size_t kNobody = static_cast<std::size_t>(-1);
constexpr double kMaxRefusedShare = 0.02;  // of the loops, see is_consistent
constexpr double kMaxSigmas = 5.0;         // of the sum of squared errors, see is_consistent
constexpr int kMaxChecks = 10;             // of sides changed after the rounds
// chi-square 99 %: 3 and 7 degrees of freedom for 6
constexpr double kPlanarShare = 11.34 / 16.81;
constexpr double kScaledShare = 18.48 / 16.81;

// Of stretches of loops that lie alike, see outvote_worst.
constexpr std::size_t kMinQuarrel = 3;   // loops that were refused: chance refuses one
constexpr std::size_t kMaxGap = 3;       // loops between two of them that were not
constexpr std::size_t kMaxQuarrels = 8;  // the longest: 45 stretches lie between them and the ends
constexpr std::size_t kMaxStretches = 4;
constexpr std::size_t kMaxTrials = 3;
constexpr double kMinGain = 3.0;  // of the limit
constexpr double kDoubt = 0.03;   // of the limit, for each loop of a stretch: the shorter rather

double limit_of(const PoseGraph& graph, const Config& config) {
  if (graph.is_planar) return kPlanarShare * config.loop_chi2;
  return (has_scales(graph) ? kScaledShare : 1.0) * config.loop_chi2;
}

double degrees_of_freedom(const PoseGraph& graph) {
  if (graph.is_planar) return 3.0;
  return has_scales(graph) ? 7.0 : 6.0;
}

}  // namespace

bool is_consistent(const PoseGraph& graph, double chi2, std::size_t num_refused) {
  const auto num_loops = std::count_if(graph.edges.begin(), graph.edges.end(),
                                       [](const PoseEdge& edge) { return edge.is_loop; });
  const double num_measured = static_cast<double>(graph.edges.size());
  const double num_free =
      static_cast<double>(graph.world_from_node.size() - held_nodes(graph).size());
  const double expected = degrees_of_freedom(graph) * std::max(0.0, num_measured - num_free);
  return static_cast<double>(num_refused) <= kMaxRefusedShare * static_cast<double>(num_loops) &&
         chi2 <= expected + kMaxSigmas * std::sqrt(2.0 * expected);
}

Graduation::Graduation(PoseGraph& graph, const Config& config)
    : graph_(graph),
      config_(config),
      problem_(graph, config),
      limit_(limit_of(graph, config)),
      outvoted_(graph.edges.size()) {
  for (std::size_t i = 0; i < graph.edges.size(); ++i)
    if (graph.edges[i].is_loop) loops_.push_back(i);
  std::stable_sort(loops_.begin(), loops_.end(), [&](std::size_t one, std::size_t other) {
    const auto later = [&](const PoseEdge& edge) { return std::max(edge.a, edge.b); };
    return later(graph.edges[one]) < later(graph.edges[other]);
  });
}

PoseGraphSummary Graduation::solve() {
  PoseGraphSummary summary;
  const State start = state();
  if (!all_fit(start, summary)) ask_all(summary);
  return weighed(std::move(summary));
}

std::optional<PoseGraphSummary> Graduation::solve_if_consistent() {
  const State start = state();
  PoseGraphSummary summary = problem_.solve(config_.graph_iterations);
  const auto is_fine = [&] {
    const auto num_refused = std::count_if(loops_.begin(), loops_.end(), [&](std::size_t loop) {
      return chi2_of(graph_, graph_.edges[loop]) > limit_;
    });
    return is_consistent(graph_, truncated_cost(), static_cast<std::size_t>(num_refused));
  };
  if (is_fine()) {
    settle(summary);
    if (is_fine()) return weighed(std::move(summary));
  }
  go_back(start);
  return std::nullopt;
}

PoseGraphSummary Graduation::solve_each() {
  PoseGraphSummary summary = problem_.solve(config_.graph_iterations);
  const double worst = worst_chi2();
  if (worst > limit_) graduate(limit_ / (2.0 * worst - limit_), summary);
  return weighed(std::move(summary));
}

// With the weights as they are now, and what is left with them.
PoseGraphSummary Graduation::weighed(PoseGraphSummary summary) const {
  summary.weights = problem_.weights();
  summary.robust_cost = 0.5 * truncated_cost();
  summary.final_cost = 0.0;
  for (std::size_t i = 0; i < graph_.edges.size(); ++i)
    summary.final_cost += 0.5 * summary.weights[i] * chi2_of(graph_, graph_.edges[i]);
  return summary;
}

void Graduation::ask_all(PoseGraphSummary& summary) {
  for (const std::size_t loop : loops_) problem_.weight(loop) = 1.0;
  go_on(config_.graph_iterations, summary);
  const double worst = worst_chi2();
  if (worst <= limit_) return;  // those in doubt have mended the rest
  graduate(limit_ / (2.0 * worst - limit_), summary);
  settle(summary);
  for (const double reach : kReaches) call_back(reach, summary);
  do {
    call_back_those_that_agree(summary);
  } while (outvote_worst(summary));
}

void Graduation::go_on(int max_iterations, PoseGraphSummary& summary) {
  summary.num_iterations += problem_.solve(max_iterations).num_iterations;
}

// Whether the graph holds together without the loops in doubt, all of it or all but one loop, and
// with those in doubt that fit it then.
bool Graduation::all_fit(const State& start, PoseGraphSummary& summary) {
  for (const std::size_t loop : loops_)
    if (graph_.edges[loop].is_doubted) problem_.weight(loop) = 0.0;
  summary = problem_.solve(config_.graph_iterations);
  return believed_fit(kNobody) ? fit_with_doubted(kNobody, summary)
                               : all_but_one_fit(start, summary);
}

// Without the one loop that is bent most: a map in which all was well before a loop lied
// need not be asked in full, unless one in doubt speaks for the liar. If not, all is as it was.
bool Graduation::all_but_one_fit(const State& start, PoseGraphSummary& summary) {
  const State before = state();
  const std::vector<double> with_liar = chi2_of_loops();
  const std::size_t liar =
      *std::max_element(loops_.begin(), loops_.end(), [&](std::size_t one, std::size_t other) {
        const auto bent = [&](std::size_t loop) {
          return graph_.edges[loop].is_doubted ? 0.0 : with_liar[loop];
        };
        return bent(one) < bent(other);
      });
  go_back(start);
  for (const std::size_t loop : loops_)
    if (loop == liar || graph_.edges[loop].is_doubted) problem_.weight(loop) = 0.0;
  go_on(config_.graph_iterations, summary);
  const std::vector<double> without_liar = chi2_of_loops();
  const bool is_spoken_for = std::any_of(loops_.begin(), loops_.end(), [&](std::size_t loop) {
    return graph_.edges[loop].is_doubted && with_liar[loop] < kSpeaksFor * without_liar[loop];
  });
  const bool is_liar = !is_spoken_for && without_liar[liar] > limit_;
  if (is_liar && believed_fit(liar) && fit_with_doubted(liar, summary)) return true;
  go_back(before);
  return false;
}

// As those in doubt had no say in where the graph is, they may be a little further off than others.
bool Graduation::fit_with_doubted(std::size_t liar, PoseGraphSummary& summary) {
  bool are_there_more = false;
  for (const std::size_t loop : loops_) {
    const PoseEdge& edge = graph_.edges[loop];
    if (!edge.is_doubted || chi2_of(graph_, edge) > kReachOfDoubted * limit_) continue;
    problem_.weight(loop) = 1.0;
    are_there_more = true;
  }
  if (!are_there_more) return true;
  go_on(config_.graph_iterations, summary);
  settle(summary);
  return believed_fit(liar);
}

// All that are not in doubt, but for the liar.
bool Graduation::believed_fit(std::size_t liar) const {
  return std::all_of(loops_.begin(), loops_.end(), [&](std::size_t loop) {
    const PoseEdge& edge = graph_.edges[loop];
    return loop == liar || edge.is_doubted || chi2_of(graph_, edge) <= limit_;
  });
}

// By edge; 0 for those that are no loops.
std::vector<double> Graduation::chi2_of_loops() const {
  std::vector<double> squares(graph_.edges.size(), 0.0);
  for (const std::size_t loop : loops_) squares[loop] = chi2_of(graph_, graph_.edges[loop]);
  return squares;
}

double Graduation::worst_chi2() const {
  double worst = 0.0;
  for (const std::size_t loop : loops_)
    worst = std::max(worst, chi2_of(graph_, graph_.edges[loop]));
  return worst;
}

// What truncated least squares minimises. Loops that were outvoted as one stretch are one lie.
double Graduation::truncated_cost() const {
  double cost = static_cast<double>(num_stretches_) * limit_;
  for (std::size_t i = 0; i < graph_.edges.size(); ++i) {
    const PoseEdge& edge = graph_.edges[i];
    const double squared = chi2_of(graph_, edge);
    if (outvoted_[i]) {
      cost += *outvoted_[i];
    } else {
      cost += edge.is_loop ? std::min(squared, limit_) : squared;
    }
  }
  return cost;
}

// To truncated least squares, from where edges beyond 1 / control of the limit have no say: the
// smaller, the more convex.
void Graduation::graduate(double control, PoseGraphSummary& summary) {
  for (int round = 0; round < kMaxRounds && !weigh(control); ++round, control *= kGrowth)
    go_on(config_.gnc_iterations, summary);
}

// Lies that were believed at first may have left a stretch of the path so far from where it is
// that none of its loops fits any more. Once they are out, what fits no worse than `reach` times
// the limit is asked again; kept if it makes the whole fit better.
void Graduation::call_back(double reach, PoseGraphSummary& summary) {
  const State before = state();
  const double cost = truncated_cost();
  graduate(1.0 / reach, summary);
  settle(summary);
  if (truncated_cost() >= cost) go_back(before);
}

// Where a long way hangs on a few loops, all of them may have been refused together: each fits only
// where the others would have put the graph. Those that say the same are believed for once; kept
// if that makes the whole fit better. They are one claim: all but one gain no more than a true loop
// costs in the mean, or look-alikes would win by their number.
void Graduation::call_back_those_that_agree(PoseGraphSummary& summary) {
  if (has_scales(graph_)) return;
  const double gain_of_number = limit_ - degrees_of_freedom(graph_);
  std::vector<std::size_t> refused;
  for (const std::size_t loop : loops_)
    if (problem_.weights()[loop] == 0.0 && !outvoted_[loop]) refused.push_back(loop);
  for (auto group : loops_that_agree(graph_, refused, limit_)) {
    // believed since, with another group
    std::erase_if(group, [&](std::size_t loop) { return problem_.weights()[loop] > 0.0; });
    if (group.size() < 2) continue;
    const State before = state();
    const double cost = truncated_cost() - static_cast<double>(group.size() - 1) * gain_of_number;
    for (const std::size_t loop : group) problem_.weight(loop) = 1.0;
    go_on(config_.graph_iterations, summary);
    const auto num_fitting = std::count_if(group.begin(), group.end(), [&](std::size_t loop) {
      return chi2_of(graph_, graph_.edges[loop]) <= limit_;
    });
    if (2 * num_fitting >= std::ssize(group)) settle(summary);
    if (truncated_cost() >= cost) go_back(before);
  }
}

// Whether every weight is 0 or 1.
bool Graduation::weigh(double control) {
  bool is_settled = true;
  for (const std::size_t loop : loops_) {
    if (outvoted_[loop]) continue;
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
void Graduation::settle(PoseGraphSummary& summary) {
  for (int check = 0; check < kMaxChecks; ++check) {
    bool has_changed = false;
    for (const std::size_t loop : loops_) {
      if (outvoted_[loop]) continue;
      const double weight = chi2_of(graph_, graph_.edges[loop]) <= limit_ ? 1.0 : 0.0;
      has_changed = has_changed || weight != problem_.weight(loop);
      problem_.weight(loop) = weight;
    }
    if (!has_changed && check > 0) return;
    go_on(config_.graph_iterations, summary);
  }
}

// Where loops that say one thing meet loops that say another, the graph refuses some of both and
// bends the odometry between: the longest of these rows of refused loops, in their order, and both
// ends of the path.
std::vector<Graduation::Stretch> Graduation::quarrels() const {
  struct Row : Stretch {
    std::size_t num_refused = 0;
  };
  std::vector<Row> rows;
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    if (problem_.weights()[loops_[i]] > 0.0 || outvoted_[loops_[i]]) continue;
    if (rows.empty() || i - rows.back().end > kMaxGap) rows.push_back({{i, i}, 0});
    rows.back().end = i + 1;
    ++rows.back().num_refused;
  }
  std::erase_if(rows, [](const Row& row) { return row.num_refused < kMinQuarrel; });
  std::stable_sort(rows.begin(), rows.end(), [](const Row& one, const Row& other) {
    return one.num_refused > other.num_refused;
  });
  rows.resize(std::min(rows.size(), kMaxQuarrels));
  std::vector<Stretch> found(rows.begin(), rows.end());
  found.push_back({0, 0});
  found.push_back({loops_.size(), loops_.size()});
  std::stable_sort(found.begin(), found.end(), [](const Stretch& one, const Stretch& other) {
    return one.begin < other.begin;
  });
  return found;
}

// With what was outvoted before, fewer than half of the loops.
bool Graduation::is_minority(const Stretch& stretch) const {
  const auto num_gone = static_cast<std::size_t>(std::count_if(
      outvoted_.begin(), outvoted_.end(), [](const auto& cost) { return cost.has_value(); }));
  return 2 * (num_gone + stretch.end - stretch.begin) < loops_.size();
}

// What lies between two quarrels.
std::vector<Graduation::Stretch> Graduation::suspects() const {
  std::vector<Stretch> found;
  const std::vector<Stretch> between = quarrels();
  for (std::size_t i = 0; i < between.size(); ++i) {
    for (std::size_t j = i + 1; j < between.size(); ++j) {
      const Stretch stretch{between[i].end, between[j].begin};
      if (stretch.begin < stretch.end && is_minority(stretch)) found.push_back(stretch);
    }
  }
  return found;
}

// Refuses a stretch, whatever fits then. What was believed of it counts what it would in the mean
// if it were true, so that true loops are worth as much inside as outside; what was refused already
// has not become a part of the one lie.
void Graduation::outvote(const Stretch& stretch, PoseGraphSummary& summary) {
  for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
    double& weight = problem_.weight(loops_[i]);
    outvoted_[loops_[i]] = weight > 0.0 ? degrees_of_freedom(graph_) + kDoubt * limit_ : limit_;
    weight = 0.0;
  }
  ++num_stretches_;
  settle(summary);
}

// The suspects without which the rest fits best at first sight.
std::vector<Graduation::Stretch> Graduation::prime_suspects(PoseGraphSummary& summary) {
  const State before = state();
  std::vector<std::pair<double, Stretch>> by_cost;
  for (const Stretch& stretch : suspects()) {
    outvote(stretch, summary);
    by_cost.emplace_back(truncated_cost(), stretch);
    go_back(before);
  }
  std::stable_sort(by_cost.begin(), by_cost.end(),
                   [](const auto& one, const auto& other) { return one.first < other.first; });
  by_cost.resize(std::min(by_cost.size(), kMaxTrials));
  std::vector<Stretch> found;
  for (const auto& [cost, stretch] : by_cost) found.push_back(stretch);
  return found;
}

// Loops of one look-alike agree with each other and prove nothing by their number: a stretch of
// them counts as one lie. It goes if what quarrels at its ends costs more.
bool Graduation::outvote_worst(PoseGraphSummary& summary) {
  if (num_stretches_ >= kMaxStretches) return false;
  const State before = state();
  double best_cost = truncated_cost() - kMinGain * limit_;
  std::optional<State> best;
  for (const Stretch& stretch : prime_suspects(summary)) {
    outvote(stretch, summary);
    for (const double reach : kReaches) call_back(reach, summary);
    const double cost = truncated_cost();
    if (cost < best_cost) {
      best_cost = cost;
      best = state();
    }
    go_back(before);
  }
  if (best) go_back(*best);
  return best.has_value();
}

Graduation::State Graduation::state() const {
  return {graph_.world_from_node, graph_.log_scales, problem_.weights(), outvoted_, num_stretches_};
}

void Graduation::go_back(const State& state) {
  graph_.world_from_node = state.poses;
  graph_.log_scales = state.log_scales;
  outvoted_ = state.outvoted;
  num_stretches_ = state.num_stretches;
  for (const std::size_t loop : loops_) problem_.weight(loop) = state.weights[loop];
  problem_.start_from_graph();
}

}  // namespace samewhere::optimize
