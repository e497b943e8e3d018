#include <algorithm>
#include <iterator>

#include <samewhere/optimize/consistent_loops.hpp>
#include <samewhere/optimize/graduated_non_convexity.hpp>
#include <samewhere/optimize/graph_consistency.hpp>
#include <samewhere/optimize/loop_segments.hpp>

namespace samewhere::optimize {
namespace {

// The control parameter of the first round: the cost is convex up to the largest squared error
// (Yang et al., RA-L 2020).
double first_control(double limit, double worst_chi2) { return limit / (2.0 * worst_chi2 - limit); }

}  // namespace

PoseGraphSummary GraduatedNonConvexity::solve() {
  if (!solve_without_suspended()) solve_with_all();
  return robust_.summary();
}

std::optional<PoseGraphSummary> GraduatedNonConvexity::solve_if_consistent() {
  const RobustGraph::State start = robust_.state();
  robust_.optimize();
  if (is_noise()) {
    robust_.classify();
    if (is_noise()) return robust_.summary();
  }
  robust_.restore(start);
  return std::nullopt;
}

PoseGraphSummary GraduatedNonConvexity::solve_each() {
  robust_.optimize();
  const double worst = robust_.worst_chi2();
  if (worst > robust_.limit()) robust_.anneal(first_control(robust_.limit(), worst));
  return robust_.summary();
}

bool GraduatedNonConvexity::is_noise() const {
  const auto num_rejected = std::count_if(robust_.loops().begin(), robust_.loops().end(),
                                          [&](std::size_t loop) { return !robust_.fits(loop); });
  return is_consistent(robust_.graph(), robust_.config(), robust_.truncated_cost(),
                       static_cast<std::size_t>(num_rejected));
}

void GraduatedNonConvexity::solve_with_all() {
  for (const std::size_t loop : robust_.loops()) robust_.set_weight(loop, 1.0);
  robust_.optimize();
  const double worst = robust_.worst_chi2();
  if (worst <= robust_.limit()) return;  // with the suspended loops all fit
  robust_.anneal(first_control(robust_.limit(), worst));
  robust_.classify();
  robust_.retest_rejected();
  do {
    retest_groups();
  } while (reject_worst_segment(robust_));
}

// Whether the graph is consistent without the suspended loops, or without these and one more, and
// with those suspended that fit it then.
bool GraduatedNonConvexity::solve_without_suspended() {
  const RobustGraph::State start = robust_.state();
  for (const std::size_t loop : robust_.loops())
    if (robust_.is_suspended(loop)) robust_.set_weight(loop, 0.0);
  robust_.optimize();
  return others_fit(std::nullopt) ? accept_suspended(std::nullopt) : solve_without_worst(start);
}

// Without the one loop with the largest squared error: after one false loop closure in a consistent
// map the full procedure is not needed, unless a suspended loop supports it. If not, the state is
// restored.
bool GraduatedNonConvexity::solve_without_worst(const RobustGraph::State& start) {
  const RobustGraph::State before = robust_.state();
  const std::vector<double> chi2_with = chi2_of_loops();
  const std::size_t outlier = worst_loop(chi2_with);
  robust_.restore(start);
  for (const std::size_t loop : robust_.loops())
    if (loop == outlier || robust_.is_suspended(loop)) robust_.set_weight(loop, 0.0);
  robust_.optimize();
  const std::vector<double> chi2_without = chi2_of_loops();
  const bool is_outlier =
      !is_supported(chi2_with, chi2_without) && chi2_without[outlier] > robust_.limit();
  if (is_outlier && others_fit(outlier) && accept_suspended(outlier)) return true;
  robust_.restore(before);
  return false;
}

// By edge; 0 for odometry.
std::vector<double> GraduatedNonConvexity::chi2_of_loops() const {
  std::vector<double> chi2(robust_.graph().edges.size(), 0.0);
  for (const std::size_t loop : robust_.loops()) chi2[loop] = robust_.chi2(loop);
  return chi2;
}

// Of the loops that are not suspended.
std::size_t GraduatedNonConvexity::worst_loop(const std::vector<double>& chi2) const {
  const auto rank = [&](std::size_t loop) { return robust_.is_suspended(loop) ? 0.0 : chi2[loop]; };
  return *std::max_element(
      robust_.loops().begin(), robust_.loops().end(),
      [&](std::size_t one, std::size_t other) { return rank(one) < rank(other); });
}

// Whether a suspended loop fits much better with a loop edge than without it.
bool GraduatedNonConvexity::is_supported(const std::vector<double>& chi2_with,
                                         const std::vector<double>& chi2_without) const {
  const double max_ratio = robust_.config().gnc.max_support_ratio;
  return std::any_of(robust_.loops().begin(), robust_.loops().end(), [&](std::size_t loop) {
    return robust_.is_suspended(loop) && chi2_with[loop] < max_ratio * chi2_without[loop];
  });
}

// Suspended loops had no weight in this solution, so they may be a little farther off than others.
bool GraduatedNonConvexity::accept_suspended(std::optional<std::size_t> outlier) {
  const double max_chi2 = robust_.config().gnc.max_suspended_ratio * robust_.limit();
  bool is_any_near = false;
  for (const std::size_t loop : robust_.loops()) {
    if (!robust_.is_suspended(loop) || robust_.chi2(loop) > max_chi2) continue;
    robust_.set_weight(loop, 1.0);
    is_any_near = true;
  }
  if (!is_any_near) return true;
  robust_.optimize();
  robust_.classify();
  return others_fit(outlier);
}

// All loops that are not suspended, except for the outlier.
bool GraduatedNonConvexity::others_fit(std::optional<std::size_t> outlier) const {
  return std::all_of(robust_.loops().begin(), robust_.loops().end(), [&](std::size_t loop) {
    return loop == outlier || robust_.is_suspended(loop) || robust_.fits(loop);
  });
}

// After a long way without loops a few of them may all be rejected, because each fits only where
// the others put the graph. Loops consistent with each other are therefore accepted together, and
// kept if the cost falls.
void GraduatedNonConvexity::retest_groups() {
  if (has_scales(robust_.graph())) return;
  std::vector<std::size_t> rejected;
  for (const std::size_t loop : robust_.loops())
    if (robust_.weight(loop) == 0.0 && !robust_.is_in_rejected_segment(loop))
      rejected.push_back(loop);
  for (auto group :
       consistent_loops(robust_.graph(), rejected, robust_.limit(), robust_.config().loop_groups)) {
    // accepted since, with another group
    std::erase_if(group, [&](std::size_t loop) { return robust_.weight(loop) > 0.0; });
    if (group.size() < 2) continue;
    const RobustGraph::State before = robust_.state();
    if (!retest_group(group)) robust_.restore(before);
  }
}

// Whether the cost falls. The group is one hypothesis: all but one of its loops gain no more than
// a true loop costs in the mean, or false ones would win by their number.
bool GraduatedNonConvexity::retest_group(const std::vector<std::size_t>& group) {
  const double gain_of_number = robust_.limit() - degrees_of_freedom(robust_.graph());
  const double cost =
      robust_.truncated_cost() - static_cast<double>(group.size() - 1) * gain_of_number;
  for (const std::size_t loop : group) robust_.set_weight(loop, 1.0);
  robust_.optimize();
  const auto num_fitting = std::count_if(group.begin(), group.end(),
                                         [&](std::size_t loop) { return robust_.fits(loop); });
  if (2 * num_fitting >= std::ssize(group)) robust_.classify();
  return robust_.truncated_cost() < cost;
}

}  // namespace samewhere::optimize
