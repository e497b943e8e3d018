#include <limits>

#include <samewhere/core/errors.hpp>
#include <samewhere/features/hamming.hpp>
#include <samewhere/features/match_pair.hpp>

namespace samewhere::features {
namespace {

constexpr int kFar = std::numeric_limits<int>::max();

struct Nearest {
  int index = -1;
  int best_bits = kFar;
  int second_bits = kFar;

  void offer(int candidate, int bits) {
    if (bits >= second_bits) return;
    if (bits < best_bits) {
      second_bits = best_bits;
      best_bits = bits;
      index = candidate;
    } else {
      second_bits = bits;
    }
  }
};

}  // namespace

std::vector<Match> match_pair(const cv::Mat& first, const cv::Mat& second, const Config& config) {
  core::require(second.empty() || second.isContinuous(), "descriptors lie one behind the other");
  std::vector<Nearest> of_first(static_cast<std::size_t>(first.rows));
  std::vector<Nearest> of_second(static_cast<std::size_t>(second.rows));
  std::vector<int> bits(of_second.size());
  for (int i = 0; i < first.rows; ++i) {
    distances_bits(first.ptr(i), second.ptr(), bits);
    Nearest nearest;
    for (int j = 0; j < second.rows; ++j) {
      const auto k = static_cast<std::size_t>(j);
      nearest.offer(j, bits[k]);
      of_second[k].offer(i, bits[k]);
    }
    of_first[static_cast<std::size_t>(i)] = nearest;
  }
  std::vector<Match> matches;
  for (int i = 0; i < first.rows; ++i) {
    const Nearest& nearest = of_first[static_cast<std::size_t>(i)];
    if (nearest.index < 0 || nearest.best_bits > config.max_distance_bits) continue;
    const bool is_mutual = of_second[static_cast<std::size_t>(nearest.index)].index == i;
    const bool is_clear =
        nearest.second_bits == kFar || nearest.best_bits < config.max_ratio * nearest.second_bits;
    if (is_mutual && is_clear) matches.push_back({i, nearest.index, nearest.best_bits});
  }
  return matches;
}

}  // namespace samewhere::features
