#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <samewhere/core/similarity.hpp>
#include <samewhere/retrieve/search.hpp>

namespace samewhere::retrieve {
namespace {

constexpr std::size_t kNumPerDraw = 3;

// |x - y|^2, eq. (5).
double squared_distance(std::span<const float> x, std::span<const float> y) {
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double difference = static_cast<double>(x[i]) - y[i];
    sum += difference * difference;
  }
  return sum;
}

// The position of the range nearest to the query, eq. (6); the range is not empty.
int nearest(const SegmentedStore& store, PositionRange range, std::span<const float> query) {
  int best = range.begin;
  double best_distance = squared_distance(query, store.vector(best));
  for (int position = range.begin + 1; position < range.end; ++position) {
    const double distance = squared_distance(query, store.vector(position));
    if (distance >= best_distance) continue;
    best = position;
    best_distance = distance;
  }
  return best;
}

// What one drawn queue contributes.
std::vector<ScoredPosition> best_of_queue(const SegmentedStore& store, PositionRange range,
                                          const SearchQuery& query, const Config& config) {
  range.end = std::min(range.end, query.num_allowed);
  if (range.begin >= range.end) return {};
  if (config.per_draw == PerDraw::kNearest) {
    range.begin = nearest(store, range, query.vector);
    range.end = range.begin + 1;
  }
  std::vector<ScoredPosition> kept;
  for (int position = range.begin; position < range.end; ++position) {
    const double similarity = core::dot(query.vector, store.vector(position));  // eq. (7)
    if (similarity > config.min_similarity) kept.push_back({position, similarity});
  }
  std::sort(kept.begin(), kept.end(), is_better);
  kept.resize(std::min(kept.size(), kNumPerDraw));
  return kept;
}

int drawn_below(core::Random& random, int bound) {
  return static_cast<int>(random.index(static_cast<std::uint64_t>(bound)));
}

// Number of frames between two views; views of different sessions are as far apart as can be.
std::uint64_t frames_between(core::FrameId a, core::FrameId b) {
  return std::max(a.value(), b.value()) - std::min(a.value(), b.value());
}

}  // namespace

bool is_better(const ScoredPosition& a, const ScoredPosition& b) {
  return a.similarity != b.similarity ? a.similarity > b.similarity : a.position < b.position;
}

std::vector<ScoredPosition> exact_search(const SegmentedStore& store, const SearchQuery& query) {
  std::vector<ScoredPosition> scored;
  scored.reserve(static_cast<std::size_t>(query.num_allowed));
  for (int position = 0; position < query.num_allowed; ++position) {
    const float product = core::dot(query.vector, store.vector(position));
    scored.push_back({position, product * store.inverse_deviation(position)});
  }
  return scored;
}

std::vector<ScoredPosition> sampled_search(const SegmentedStore& store, const SearchQuery& query,
                                           const Config& config, core::Random& random) {
  std::vector<ScoredPosition> found;
  if (store.num_vectors() == 0) return found;
  const int queues_per_group = store.queues_per_group();
  std::vector<bool> is_drawn(static_cast<std::size_t>(store.num_groups() * queues_per_group));
  for (int draw = 0; draw < config.num_draws; ++draw) {
    const int group = drawn_below(random, store.num_groups());
    const int queue = drawn_below(random, queues_per_group);
    // a queue drawn again could only repeat what it gave
    const auto drawn = static_cast<std::size_t>(group * queues_per_group + queue);
    if (is_drawn[drawn]) continue;
    is_drawn[drawn] = true;
    const auto kept = best_of_queue(store, store.queue(group, queue), query, config);
    found.insert(found.end(), kept.begin(), kept.end());
  }
  return found;
}

std::vector<ScoredPosition> every_queue_search(const SegmentedStore& store,
                                               const SearchQuery& query, const Config& config) {
  std::vector<ScoredPosition> found;
  for (int group = 0; group < store.num_groups(); ++group) {
    for (int queue = 0; queue < store.queues_per_group(); ++queue) {
      const auto kept = best_of_queue(store, store.queue(group, queue), query, config);
      found.insert(found.end(), kept.begin(), kept.end());
    }
  }
  return found;
}

std::vector<ScoredPosition> best_places(const SegmentedStore& store,
                                        std::vector<ScoredPosition> scored, const Config& config) {
  const auto place_frames = static_cast<std::uint64_t>(std::max(config.place_frames, 1));
  std::vector<ScoredPosition> best;
  while (!scored.empty() && best.size() < static_cast<std::size_t>(config.num_candidates)) {
    best.push_back(*std::min_element(scored.begin(), scored.end(), is_better));
    const core::FrameId taken = store.frame(best.back().position);
    std::erase_if(scored, [&](const ScoredPosition& other) {
      return frames_between(store.frame(other.position), taken) < place_frames;
    });
  }
  return best;
}

}  // namespace samewhere::retrieve
