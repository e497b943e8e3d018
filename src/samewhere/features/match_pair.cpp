#include <algorithm>
#include <cstdint>
#include <limits>

#include <samewhere/core/errors.hpp>
#include <samewhere/features/hamming.hpp>
#include <samewhere/features/match_pair.hpp>

namespace samewhere::features {
namespace {

constexpr std::int16_t kFar = std::numeric_limits<std::int16_t>::max();

// Of each descriptor of the second image the nearest of the first, of equals the first one.
struct NearestRows {
  explicit NearestRows(std::size_t count) : bits(count, kFar), row(count, -1) {}

  void offer(std::int16_t candidate, const std::vector<std::int16_t>& distances) {
    for (std::size_t j = 0; j < bits.size(); ++j) {
      const bool is_nearer = distances[j] < bits[j];
      bits[j] = is_nearer ? distances[j] : bits[j];
      row[j] = is_nearer ? candidate : row[j];
    }
  }

  std::vector<std::int16_t> bits;
  std::vector<std::int16_t> row;
};

std::int16_t smallest(const std::vector<std::int16_t>& distances) {
  std::int16_t least = kFar;
  for (const std::int16_t bits : distances) least = std::min(least, bits);
  return least;
}

}  // namespace

std::vector<Match> match_pair(const cv::Mat& first, const cv::Mat& second, const Config& config) {
  core::require(second.empty() || second.isContinuous(), "descriptors lie one behind the other");
  core::require(first.rows <= kFar, "at most 32767 descriptors are matched");
  std::vector<std::int16_t> distances(static_cast<std::size_t>(second.rows));
  NearestRows of_second(distances.size());
  std::vector<Match> clear;  // not yet mutual
  for (int i = 0; i < first.rows; ++i) {
    distances_bits(first.ptr(i), second.ptr(), distances);
    of_second.offer(static_cast<std::int16_t>(i), distances);
    const std::int16_t best = smallest(distances);
    if (best > config.max_distance_bits) continue;
    const auto nearest =
        static_cast<std::size_t>(std::ranges::find(distances, best) - distances.begin());
    distances[nearest] = kFar;
    const std::int16_t next = smallest(distances);
    if (next == kFar || best < config.max_ratio * next)
      clear.push_back({i, static_cast<int>(nearest), best});
  }
  std::erase_if(clear, [&](const Match& match) {
    return of_second.row[static_cast<std::size_t>(match.second)] != match.first;
  });
  return clear;
}

}  // namespace samewhere::features
