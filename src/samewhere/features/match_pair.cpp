#include <limits>

#include <opencv2/core/hal/hal.hpp>

#include <samewhere/features/match_pair.hpp>

namespace samewhere::features {
namespace {

constexpr int kBytes = 32;
constexpr int kFar = std::numeric_limits<int>::max();

struct Nearest {
  int index = -1;
  int best_bits = kFar;
  int second_bits = kFar;

  void offer(int candidate, int bits) {
    if (bits < best_bits) {
      second_bits = best_bits;
      best_bits = bits;
      index = candidate;
    } else if (bits < second_bits) {
      second_bits = bits;
    }
  }
};

}  // namespace

int distance_bits(const unsigned char* a, const unsigned char* b) {
  return cv::hal::normHamming(a, b, kBytes);
}

std::vector<Match> match_pair(const cv::Mat& first, const cv::Mat& second, const Config& config) {
  std::vector<Nearest> of_first(static_cast<std::size_t>(first.rows));
  std::vector<Nearest> of_second(static_cast<std::size_t>(second.rows));
  for (int i = 0; i < first.rows; ++i) {
    const unsigned char* row = first.ptr(i);
    for (int j = 0; j < second.rows; ++j) {
      const int bits = distance_bits(row, second.ptr(j));
      of_first[static_cast<std::size_t>(i)].offer(j, bits);
      of_second[static_cast<std::size_t>(j)].offer(i, bits);
    }
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
