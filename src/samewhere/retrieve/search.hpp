#pragma once

#include <span>
#include <vector>

#include <samewhere/core/random.hpp>
#include <samewhere/retrieve/config.hpp>
#include <samewhere/retrieve/segmented_store.hpp>

namespace samewhere::retrieve {

// A stored vector and how much it resembles the query's.
struct ScoredPosition {
  int position = 0;
  double similarity = 0.0;

  bool operator==(const ScoredPosition&) const = default;
};

// More similar first; of equals the older first.
bool is_better(const ScoredPosition& a, const ScoredPosition& b);

// A query's vector (exact search: core::centred_unit of it), and how many of the stored ones it may
// match: positions 0 .. num_allowed - 1.
struct SearchQuery {
  std::span<const float> vector;
  int num_allowed = 0;
};

// NCC, eq. (8)-(13), with every allowed vector, in the order of the store. Reads the store once, as
// fast as memory gives it.
std::vector<ScoredPosition> exact_search(const SegmentedStore& store, const SearchQuery& query);

// The published preliminary match (its Table 1; it says RANSAC, but samples without a model): L
// draws with replacement, each a random group and in it a random queue; of each queue the vectors
// whose cosine with the query exceeds min_similarity, eq. (7), and of these the best three, or the
// one nearest to the query, eq. (5)-(6). A queue that is empty or too young gives nothing. All
// vectors are of unit length (or zero). Every position at most once, in the order of drawing.
std::vector<ScoredPosition> sampled_search(const SegmentedStore& store, const SearchQuery& query,
                                           const Config& config, core::Random& random);

// The same with every queue taken once: what sampled_search tends to with ever more draws. In the
// order of the store.
std::vector<ScoredPosition> every_queue_search(const SegmentedStore& store,
                                               const SearchQuery& query, const Config& config);

// The best `config.num_candidates`, best first. Of vectors that lie closer than place_frames frames
// to a better one none is kept: they are views of the same place.
std::vector<ScoredPosition> best_places(const SegmentedStore& store,
                                        std::vector<ScoredPosition> scored, const Config& config);

}  // namespace samewhere::retrieve
