#include <limits>

#include <opencv2/core/hal/intrin.hpp>

#include <samewhere/features/describe.hpp>
#include <samewhere/features/match_pair.hpp>

namespace samewhere::features {
namespace {

constexpr int kHalfBytes = kDescriptorBytes / 2;
static_assert(kHalfBytes == cv::v_uint8x16::nlanes);
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
  const auto bits_of_half = [&](int first) {
    return cv::v_popcount(cv::v_load(a + first) ^ cv::v_load(b + first));
  };
  return static_cast<int>(cv::v_reduce_sum(bits_of_half(0) + bits_of_half(kHalfBytes)));
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
