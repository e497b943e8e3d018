#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <samewhere/core/random.hpp>

namespace samewhere::geometry {

struct RansacOptions {
  double max_error_px = 3.0;  // an observation with a smaller error is an inlier
  int max_iterations = 500;   //
  double confidence =
      0.9999;  // stop once the chance of having missed a better model is below 1 - confidence
  int min_inliers = 8;  // fewer are no model
};

template <class Model>
struct RansacResult {
  Model model;
  std::vector<int> inliers;  // indices, ascending
  int num_iterations = 0;
};

// What RANSAC found for one model: the truncated sum of squared errors (MSAC) and the inliers.
struct RansacScore {
  double cost = 0.0;
  std::vector<int> inliers;
};

// How many samples of `sample_size` must be drawn until one of inliers only has come with this
// confidence.
inline double needed_iterations(double inlier_ratio, int sample_size, double confidence) {
  const double clean = std::pow(inlier_ratio, sample_size);
  if (clean >= 1.0) return 1.0;
  if (clean <= 0.0) return 1e300;
  return std::log(1.0 - confidence) / std::log1p(-clean);
}

// Random sample consensus (Fischler and Bolles 1981) with the score of MSAC (Torr and Zisserman
// 2000). The Problem says
//
//   using Model = ...;                                       what is estimated
//   static constexpr int kSampleSize = ...;                  how many observations fix it
//   int size() const;                                        how many observations there are
//   std::vector<Model> generate(const std::vector<int>& sample) const;
//   double squared_error(const Model& model, int i) const;   in square pixels, infinity where it
//   makes no sense
//
// The same Random gives the same answer. Nothing if no model has min_inliers.
template <class Problem>
std::optional<RansacResult<typename Problem::Model>> ransac(const Problem& problem,
                                                            const RansacOptions& options,
                                                            core::Random& random);

template <class Problem>
RansacScore score_model(const Problem& problem, const typename Problem::Model& model,
                        double max_error_px) {
  const double max_squared = max_error_px * max_error_px;
  RansacScore score;
  for (int i = 0; i < problem.size(); ++i) {
    const double squared = problem.squared_error(model, i);
    const bool is_inlier = squared < max_squared;  // false for NaN
    score.cost += is_inlier ? squared : max_squared;
    if (is_inlier) score.inliers.push_back(i);
  }
  return score;
}

template <class Problem>
std::optional<RansacResult<typename Problem::Model>> ransac(const Problem& problem,
                                                            const RansacOptions& options,
                                                            core::Random& random) {
  if (problem.size() < std::max(Problem::kSampleSize, options.min_inliers)) return std::nullopt;
  std::optional<RansacResult<typename Problem::Model>> best;
  double best_cost = 0.0;
  double needed = options.max_iterations;
  int iteration = 0;
  for (; iteration < options.max_iterations && iteration < needed; ++iteration) {
    const std::vector<int> sample = random.distinct_indices(Problem::kSampleSize, problem.size());
    for (const auto& model : problem.generate(sample)) {
      RansacScore score = score_model(problem, model, options.max_error_px);
      if (best && score.cost >= best_cost) continue;
      best_cost = score.cost;
      const double ratio = static_cast<double>(score.inliers.size()) / problem.size();
      needed = needed_iterations(ratio, Problem::kSampleSize, options.confidence);
      best = {model, std::move(score.inliers), 0};
    }
  }
  if (!best || static_cast<int>(best->inliers.size()) < options.min_inliers) return std::nullopt;
  best->num_iterations = iteration;
  return best;
}

}  // namespace samewhere::geometry
