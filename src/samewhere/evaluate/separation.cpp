#include <algorithm>
#include <functional>

#include <samewhere/evaluate/separation.hpp>

namespace samewhere::evaluate {
namespace {

// Both descend.
double kept(const std::vector<double>& true_scores, const std::vector<double>& wrong_scores,
            int wrong_per_thousand) {
  const std::size_t num_allowed =
      wrong_scores.size() * static_cast<std::size_t>(wrong_per_thousand) / 1000;
  const double refused = wrong_scores[num_allowed];  // the first that must not pass
  const auto end = std::partition_point(true_scores.begin(), true_scores.end(),
                                        [refused](double score) { return score > refused; });
  return static_cast<double>(end - true_scores.begin()) / static_cast<double>(true_scores.size());
}

double auc(const std::vector<double>& true_scores, const std::vector<double>& wrong_scores) {
  double wins = 0.0;
  for (const double score : true_scores) {
    const auto [tied, below] =
        std::equal_range(wrong_scores.begin(), wrong_scores.end(), score, std::greater<>());
    wins +=
        static_cast<double>(wrong_scores.end() - below) + 0.5 * static_cast<double>(below - tied);
  }
  return wins /
         (static_cast<double>(true_scores.size()) * static_cast<double>(wrong_scores.size()));
}

}  // namespace

Separation separation_of(std::vector<double> true_scores, std::vector<double> wrong_scores) {
  Separation separation{.num_true = static_cast<int>(true_scores.size()),
                        .num_wrong = static_cast<int>(wrong_scores.size())};
  if (true_scores.empty() || wrong_scores.empty()) return separation;
  std::sort(true_scores.begin(), true_scores.end(), std::greater<>());
  std::sort(wrong_scores.begin(), wrong_scores.end(), std::greater<>());
  separation.auc = auc(true_scores, wrong_scores);
  separation.kept_at_1_percent = kept(true_scores, wrong_scores, 10);
  separation.kept_at_0_1_percent = kept(true_scores, wrong_scores, 1);
  return separation;
}

}  // namespace samewhere::evaluate
