#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <samewhere/core/truth.hpp>

namespace samewhere::bench {

// Role of a frame for a query.
enum class Offer {
  kTakenOut,   // the place or time of the query: never on the shortlist
  kSamePlace,  // another view of the same place: on the shortlist
  kAliased,    // another place: the two views are an aliased pair
};

// Which frames are offered to a query, to measure perceptual aliasing.
struct AliasedPairRule {
  std::string name;
  std::vector<int> queries;  // frames, ascending
  std::function<Offer(int query, int match)> offer;
};

// Frames of a source, in order.
struct KnownFrames {
  std::vector<std::string> names;
  std::vector<double> stamps_s;
  core::Truth truth;
};

// The rules that the truth of a source allows; queries are at least `query_step` frames apart:
// * "other places": all frames except those of the same or a near place (protocol pr-v2, in either
//   order) and those within 10 s of the query;
// * "aliased pairs": only the pairs of truth.aliased_pairs, in either order; if the truth has some.
// Throws InputError if the truth has no places.
std::vector<AliasedPairRule> rules_of_truth(const KnownFrames& frames, int query_step);

// Protocol floor-v2, clip-out: `num_queries` of the queries in dataset.csv, drawn by a fixed
// permutation. Gallery images of other clips are offered; those of another floor are aliased.
// Frames are those of walk.txt, in its order. Throws InputError.
AliasedPairRule tower_rule(const std::filesystem::path& folder, int num_queries);

}  // namespace samewhere::bench
