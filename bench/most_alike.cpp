#include "most_alike.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace samewhere::bench {

float dot(const std::vector<float>& a, const std::vector<float>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0F);
}

std::vector<int> most_alike(const std::vector<std::vector<float>>& vectors, int query,
                            const std::vector<int>& offered, int count) {
  std::vector<std::pair<float, int>> ranked;
  ranked.reserve(offered.size());
  for (const int match : offered) {
    // negated, so that the usual order puts the most alike first and breaks ties by index
    ranked.emplace_back(
        -dot(vectors[static_cast<std::size_t>(query)], vectors[static_cast<std::size_t>(match)]),
        match);
  }
  const std::size_t num_kept = std::min(ranked.size(), static_cast<std::size_t>(count));
  std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(num_kept),
                    ranked.end());
  std::vector<int> best(num_kept);
  for (std::size_t i = 0; i < num_kept; ++i) best[i] = ranked[i].second;
  return best;
}

}  // namespace samewhere::bench
